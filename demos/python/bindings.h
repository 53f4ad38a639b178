#pragma once

#include <pybind11/pybind11.h>

#include <filesystem>
#include <memory>
#include <vector>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/force/law/flow_settings.h"
#include "bullet_ambient/force/medium/medium.h"
#include "demos/scene/scene.h"
#include "demos/scene/scene_reader.h"

namespace ambient {

// Each function binds a part of the module. Call in this order: signatures need earlier types.

void bindSettings(pybind11::module_& module);
void bindFluidBody(pybind11::module_& module);
void bindScene(pybind11::module_& module);
void bindMotion(pybind11::module_& module);
void bindRobot(pybind11::module_& module);
void bindWorld(pybind11::module_& module);
void bindSweep(pybind11::module_& module);
void bindWorldBatch(pybind11::module_& module);

/// Converts a Medium of Python. @throws TypeError if it is none, ValueError if no fluid has its
/// numbers
Medium mediumFrom(const pybind11::object& settings);
/// Converts FlowSettings of Python; None: the usual ones. @throws TypeError, ValueError
FlowSettings flowFrom(const pybind11::object& settings);
/// Makes a Medium of Python.
pybind11::object toPython(const Medium& medium);

/// Converts a dict such as {"bodies.0.mass": 0.1} to overrides.
std::vector<SceneOverride> overridesFrom(const pybind11::dict& changes);

/// Binds from_mesh(), from_shape(), read(), write() and scaled() of the Python class FluidBody.
void bindMakers(pybind11::class_<FluidBody, std::shared_ptr<FluidBody>>& type);

}  // namespace ambient
