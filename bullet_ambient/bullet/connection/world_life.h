#pragma once

#include <memory>

#include "bullet_ambient/bullet/core/precision_check.h"

class btDiscreteDynamicsWorld;
class btSimulationIslandManager;

AMBIENT_BEGIN

class AmbientBodies;

/// Whether a world is alive. Its end is the end of what is in its fluid.
struct WorldLife {
  std::weak_ptr<AmbientBodies> members;
  btSimulationIslandManager* given = nullptr;  ///< the world's own island manager
  bool has_ended = false;
};

/// Watches a world by an island manager that works as its own does.
/// @throws std::invalid_argument if the world has an island manager of a class of its own.
void watch(btDiscreteDynamicsWorld& world, const std::shared_ptr<WorldLife>& life);

/// Gives the world its own island manager back. @pre it is alive
void stopWatching(btDiscreteDynamicsWorld& world, WorldLife& life);

AMBIENT_END
