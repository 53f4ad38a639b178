#pragma once

#include <nlohmann/json_fwd.hpp>

#include "demos/scene/scene.h"

namespace ambient {

/// Reads the entry of a robot and its URDF file. Adds the robot to scene.robots, and each link with
/// a collision shape to scene.bodies, named robot/link. @pre the schema has accepted the entry
/// @throws std::runtime_error, one line that names the file, the place, the value and the limit.
void addRobot(const nlohmann::json& from, Scene& scene);

}  // namespace ambient
