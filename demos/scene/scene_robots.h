#pragma once

#include <nlohmann/json_fwd.hpp>

#include "demos/scene/scene.h"

namespace ambient {

/// End of the line that refuses what is built with BULLET_AMBIENT_WHOLE_DEMO=ON only.
constexpr char kNeedsWholeDemo[] =
    "needs the whole ambient_demo: `demos/run SCENE`, or CMake's -DBULLET_AMBIENT_WHOLE_DEMO=ON";

/// Reads the entry of a robot and its URDF file. Adds the robot to scene.robots, and each link with
/// a collision shape to scene.bodies, named robot/link. @pre the schema has accepted the entry
/// @throws std::runtime_error, one line that names the file, the place, the value and the limit.
void addRobot(const nlohmann::json& from, Scene& scene);

}  // namespace ambient
