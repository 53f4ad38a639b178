#pragma once

#include <nlohmann/json_fwd.hpp>

#include "demos/scene/scene.h"

namespace ambient {

/// Reads a robot of a scene and its URDF file, and adds it and the links that collide to the scene,
/// each as a body called robot/link. @pre the schema has let it pass
/// @throws std::runtime_error, one line that names the file, the place, the value and the limit.
void addRobot(const nlohmann::json& from, Scene& scene);

}  // namespace ambient
