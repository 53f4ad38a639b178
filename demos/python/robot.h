#pragma once

#include <memory>

#include "demos/python/python_world.h"
#include "demos/simulation/robots/scene_robot.h"

namespace ambient {

/// One robot of a world; keeps the world alive.
struct PythonRobot {
  std::shared_ptr<PythonWorld> world;
  std::size_t index = 0;

  SceneRobot& get() const { return world->simulation().robot(index); }
};

}  // namespace ambient
