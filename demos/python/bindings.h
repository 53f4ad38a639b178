#pragma once

#include <pybind11/pybind11.h>

namespace ambient {

// Each function binds a part of the module. Call in this order: signatures need earlier types.

void bindSettings(pybind11::module_& module);
void bindFluidBody(pybind11::module_& module);
void bindScene(pybind11::module_& module);
void bindMotion(pybind11::module_& module);
void bindRobot(pybind11::module_& module);
void bindWorld(pybind11::module_& module);
void bindSweep(pybind11::module_& module);

}  // namespace ambient
