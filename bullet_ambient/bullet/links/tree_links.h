#pragma once

#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/members/ambient_bodies.h"

AMBIENT_BEGIN

/// Substep of the world of the trees.
struct TreeTask {
  AmbientBodies& bodies;
  double duration;  ///< [s]
  btVector3 gravity;
};

/// Makes the task of a substep of `time_step` [s]. @pre there are trees
inline TreeTask taskOf(AmbientBodies& bodies, btScalar time_step) {
  return {bodies, static_cast<double>(time_step), bodies.trees.world()->getGravity()};
}

/// Calls visit(AmbientTree&) for each tree whose multibody is in the world. Multibodies outside it
/// may have been destroyed.
template <class Visit>
void forEachTree(btMultiBodyDynamicsWorld& world, const AmbientTrees& trees, const Visit& visit) {
  for (int i = 0; i < world.getNumMultibodies(); ++i)
    if (AmbientTree* tree = trees.find(world.getMultiBody(i))) visit(*tree);
}

/// Updates links, fluids and forces of a tree at the start of a substep. Places the links if
/// regions, a smooth link or a tree without joints need it. Returns false if no link is in a fluid.
/// Allocates nothing.
bool prepareLinks(AmbientTree& tree, const TreeTask& task) noexcept;

/// True if the velocity `now` is not `step.end`, up to Bullet's rounding: others have changed it
/// since the last substep.
bool wasMovedByOthers(const AmbientTree& tree, const CoordinatesIn& now) noexcept;

/// Makes the links forget the loads at the end of the last flight, which the motion has left.
void forgetLoads(AmbientTree& tree) noexcept;

/// Sets the motion of each link, AmbientLink::now, to that at `step.pose` and for the generalized
/// velocity `u`. Leaves the dynamics there, with the models that they had.
void placeLinks(AmbientTree& tree, const CoordinatesIn& u) noexcept;

/// Sets the motion of each link to the present one. Call between two steps.
void placeLinksNow(AmbientTree& tree) noexcept;

/// Adds the counts of a flight to the counters of the links: substeps to all, load evaluations in
/// equal parts to those with loads, all others to the first link.
void addCount(const FlightCount& count, AmbientTree& tree) noexcept;

/// Adds energy that a bound has removed from the motion of a tree [J] to the counter of its first
/// link.
void countEnergyRemoved(double energy, AmbientTree& tree) noexcept;

/// Wakes a tree that drifts or moves afloat, whose fluid changes with time, or that floats in an
/// unstable balance; like keepAwakeWhileMoving() and keepAwakeInUnsteadyFluid() of bodies.
void keepTreeAwake(AmbientTree& tree) noexcept;

AMBIENT_END
