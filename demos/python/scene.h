#pragma once

#include <pybind11/pybind11.h>

#include <filesystem>
#include <vector>

#include "demos/scene/scene.h"
#include "demos/scene/scene_override.h"

namespace ambient {

/// Converts a dict such as {"bodies.0.mass": 0.1} to overrides.
std::vector<SceneOverride> overridesFrom(const pybind11::dict& changes);

}  // namespace ambient
