#pragma once

#include <pybind11/pybind11.h>

#include <filesystem>
#include <vector>

#include "demos/scene/scene.h"
#include "demos/scene/scene_override.h"

namespace ambient {

/// {"bodies.0.mass": 0.1} as overrides.
std::vector<SceneOverride> overridesFrom(const pybind11::dict& changes);

}  // namespace ambient
