#include "bullet_ambient/bullet/ambient_action.h"

#include <BulletCollision/CollisionDispatch/btCollisionWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>

#include <cmath>
#include <utility>

#include "bullet_ambient/bullet/ambient_bodies.h"
#include "bullet_ambient/bullet/flight_coupling.h"
#include "bullet_ambient/bullet/region_call.h"
#include "bullet_ambient/bullet/row_motion.h"
#include "bullet_ambient/bullet/tree_group.h"

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {

namespace {

// Asks the world, not the registry: a body there may have been destroyed.
bool hasAwakeMember(const btCollisionWorld& world, const AmbientBodies& bodies) {
  const btCollisionObjectArray& objects = world.getCollisionObjectArray();
  for (int i = 0; i < objects.size(); ++i) {
    const AmbientBody* ambient = bodies.find(objects[i]);
    if (ambient && ambient->isInFluid() && objects[i]->isActive() &&
        !objects[i]->isStaticOrKinematicObject()) {
      return true;
    }
  }
  return hasAwakeTree(world, bodies);
}

// Whether the body that the solver met is still there: it may have been removed and destroyed
// since, by another action, or long ago if that substep had no action. Removals swap the world's
// array.
bool isStillIn(const btCollisionWorld& world, const AmbientBody& ambient) {
  const btCollisionObjectArray& objects = world.getCollisionObjectArray();
  int index = ambient.outcome.world_index;
  if (index < 0 || index >= objects.size() || objects[index] != ambient.body) {
    index = objects.findLinearSearch(ambient.body);
  }
  return index < objects.size() && AmbientBodies::isSame(ambient);
}

void complete(Outcome kind, AmbientBody& ambient, double time_step, Complaints& complaints) {
  if (kind == Outcome::kHeld) return release(ambient);
  if (kind == Outcome::kFlown) {
    endFlight(ambient, time_step);
  } else {
    endRowMotion(ambient, time_step, complaints);
  }
  if (kind != Outcome::kRows) keepAwakeWhileMoving(ambient);
  keepAwakeInUnsteadyFluid(ambient);
}

// Clears contact impulses after a substep whose duration is not finite: the next one would start
// its contacts with them.
void forgetBrokenImpulses(btCollisionWorld& world) {
  btDispatcher& dispatcher = *world.getDispatcher();
  for (int i = 0; i < dispatcher.getNumManifolds(); ++i) {
    btPersistentManifold& manifold = *dispatcher.getManifoldByIndexInternal(i);
    for (int k = 0; k < manifold.getNumContacts(); ++k) {
      btManifoldPoint& point = manifold.getContactPoint(k);
      for (btScalar* impulse : {&point.m_appliedImpulse, &point.m_appliedImpulseLateral1,
                                &point.m_appliedImpulseLateral2})
        if (!std::isfinite(*impulse)) *impulse = 0;
    }
  }
}

// Those that the world has: others may have been destroyed.
void wakeFollowers(const btCollisionWorld& world, const AmbientBodies& bodies) {
  const btCollisionObjectArray& objects = world.getCollisionObjectArray();
  for (int i = 0; i < objects.size(); ++i) {
    const AmbientBody* ambient = bodies.find(objects[i]);
    if (ambient && ambient->def.follow_regions) objects[i]->activate();
  }
  wakeFollowingTrees(world, bodies);
}

}  // namespace

// In two substeps in a row: another action may have woken the body after the solver's turn.
bool AmbientAction::isSolverMissing(const btCollisionWorld& world) {
  const AmbientBodies& bodies = bodiesOf(registry_);
  const unsigned solved = bodies.solved;
  const bool is_missing = std::exchange(solved_, solved) == solved &&
                          (bodies.size() > 0 || !bodies.trees.empty()) &&
                          hasAwakeMember(world, bodies);
  return std::exchange(was_missing_, is_missing) && is_missing;
}

void AmbientAction::updateAction(btCollisionWorld* world, btScalar time_step) {
  world_ = world;
  AmbientBodies& bodies = bodiesOf(registry_);
  for (AmbientBody* ambient = bodies.takeMet(); ambient; ambient = ambient->next_met) {
    const Outcome kind = std::exchange(ambient->outcome.kind, Outcome::kNotMet);
    if (kind == Outcome::kStock || !isStillIn(*world, *ambient)) continue;
    complete(kind, *ambient, static_cast<double>(time_step), bodies.complaints);
  }
  completeTrees(*world, bodies, static_cast<double>(time_step));
  if (std::isfinite(time_step)) {
    bodies.regions.time += static_cast<double>(time_step);
  } else if (bodies.size() > 0 || !bodies.trees.empty() || !bodies.regions.empty()) {
    bodies.complaints.say(Complaint::kDuration);
    forgetBrokenImpulses(*world);
  }
  if (std::exchange(bodies.regions.has_changed, false)) wakeFollowers(*world, bodies);
  if (isSolverMissing(*world)) {
    const bool has_multibodies = dynamic_cast<const btMultiBodyDynamicsWorld*>(world);
    bodies.complaints.say(has_multibodies ? Complaint::kNoMultiBodySolver : Complaint::kNoSolver);
  }
  for (const auto& attachment : followed_) attachment->update(*world);
}

void AmbientAction::follow(std::unique_ptr<WorldAttachment> attachment) {
  followed_.push_back(std::move(attachment));
}

void AmbientAction::debugDraw(btIDebugDraw* drawer) {
  if (!drawer || !world_ || !drawing.drawsAnything()) return;
  const FluidRegions& regions = bodiesOf(registry_).regions;
  const auto* dynamics = dynamic_cast<const btDynamicsWorld*>(world_);
  if (drawing.water_surface && dynamics) {
    const btVector3 gravity = const_cast<btDynamicsWorld*>(dynamics)->getGravity();
    RegionCall call(regions);
    for (const auto& [id, entry] : regions.all())
      drawSurface({entry.region, gravity, regions.time}, drawing, *drawer);
  }
  const btCollisionObjectArray& objects = world_->getCollisionObjectArray();
  for (int i = 0; i < objects.size(); ++i) {
    const AmbientBody* ambient = bodiesOf(registry_).find(objects[i]);
    if (ambient && ambient->isInFluid() && !objects[i]->isStaticOrKinematicObject()) {
      drawFluid(*ambient, drawing, *drawer);
    }
  }
  drawTrees(*world_, bodiesOf(registry_), drawing, *drawer);
}

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
