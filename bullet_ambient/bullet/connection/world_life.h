#pragma once

#include <memory>

#include "bullet_ambient/bullet/core/precision_check.h"

class btDiscreteDynamicsWorld;
class btSimulationIslandManager;

AMBIENT_BEGIN

class AmbientBodies;

/// Says whether a world is alive. When the world is destroyed, all members leave their fluid.
struct WorldLife {
  std::weak_ptr<AmbientBodies> members;
  btSimulationIslandManager* given = nullptr;  ///< the world's own island manager
  bool has_ended = false;
};

/// Begins to watch a world: replaces its island manager by one that works alike and reports its
/// destruction.
/// @throws std::invalid_argument if the world has an island manager of a class of its own.
void watch(btDiscreteDynamicsWorld& world, const std::shared_ptr<WorldLife>& life);

/// Gives the world its own island manager back. @pre the world is alive
void stopWatching(btDiscreteDynamicsWorld& world, WorldLife& life);

AMBIENT_END
