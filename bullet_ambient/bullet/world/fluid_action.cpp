#include "bullet_ambient/bullet/world/fluid_action.h"

#include <BulletCollision/CollisionDispatch/btCollisionWorld.h>
#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>

#include <cmath>
#include <utility>

#include "bullet_ambient/bullet/core/body_motion.h"
#include "bullet_ambient/bullet/links/tree_step.h"
#include "bullet_ambient/bullet/members/ambient_bodies.h"
#include "bullet_ambient/bullet/members/attach.h"
#include "bullet_ambient/bullet/members/flight_coupling.h"
#include "bullet_ambient/bullet/members/tree_state.h"
#include "bullet_ambient/bullet/rows/constraint_rows.h"
#include "bullet_ambient/drawing.h"
#include "bullet_ambient/immersed/fluid_regions.h"
#include "bullet_ambient/immersed/wrench_sensor.h"

AMBIENT_BEGIN

namespace {

// Calls visit(AmbientBody&) for the bodies and links that a world has. Asks the world, not the
// fluid: a body there may have been destroyed.
template <class Visit>
void forEachIn(const btCollisionWorld& world, const AmbientBodies& bodies, const Visit& visit) {
  const btCollisionObjectArray& objects = world.getCollisionObjectArray();
  for (int i = 0; i < objects.size(); ++i)
    if (AmbientBody* ambient = bodies.find(objects[i])) visit(*ambient);
  forEachTreeIn(world, bodies.trees, [&visit](const AmbientTree& tree) {
    for (const auto& link : tree.links) visit(link->ambient);
  });
}

// True if the fluid acts on a body that is awake.
bool isMoved(const AmbientBody& ambient) {
  return ambient.isInFluid() && ambient.body->isActive() &&
         !ambient.body->isStaticOrKinematicObject();
}

bool hasAwakeBody(const btCollisionWorld& world, const AmbientBodies& bodies) {
  bool is_awake = false;
  forEachIn(world, bodies, [&is_awake](const AmbientBody& ambient) {
    is_awake |= ambient.body ? isMoved(ambient) : !isAsleep(*ambient.multi_body);
  });
  return is_awake;
}

// Whether the body that the solver has worked on is still there: it may have been removed and
// destroyed since, by another action, or long ago if that substep had no action. Removals swap the
// world's array.
bool isStillIn(const btCollisionWorld& world, const AmbientBody& ambient) {
  const btCollisionObjectArray& objects = world.getCollisionObjectArray();
  int index = ambient.outcome.world_index;
  if (index < 0 || index >= objects.size() || objects[index] != ambient.body) {
    index = objects.findLinearSearch(ambient.body);
  }
  return index < objects.size() && AmbientBodies::isSame(ambient);
}

// Completes the substep of the bodies that the solver has worked on, after Bullet has moved them;
// of bodies that did not fly, several side by side.
void completeBodies(const btCollisionWorld& world, AmbientBodies& bodies, double time_step) {
  AmbientBody* moved[kFlightsTogether] = {};
  Outcome kinds[kFlightsTogether] = {};
  Twist before_W[kFlightsTogether];
  int count = 0;
  const auto finish = [&](AmbientBody& ambient, Outcome kind, const Twist& before) {
    keepAwake(ambient, kind);
    if (ambient.sensor)
      finishBodyReading(ambient, kind, motionOf(*ambient.body), before, time_step);
  };
  const auto completeRows = [&] {
    if (count > 0) endRowMotions(moved, count, time_step, bodies.warnings);
    for (int i = 0; i < count; ++i) finish(*moved[i], kinds[i], before_W[i]);
    count = 0;
  };
  for (AmbientBody* ambient = bodies.takeSolved(); ambient; ambient = ambient->next_solved) {
    const Outcome kind = std::exchange(ambient->outcome.kind, Outcome::kNotSolved);
    if (kind == Outcome::kStock || !isStillIn(world, *ambient)) continue;
    const Twist before = ambient->sensor ? velocityOf(*ambient->body) : Twist{};
    if (kind == Outcome::kDisabled) {
      restoreActivation(*ambient);
    } else if (kind == Outcome::kFlown) {
      endFlight(*ambient, time_step);
      finish(*ambient, kind, before);
    } else {
      moved[count] = ambient;
      kinds[count] = kind;
      before_W[count++] = before;
      if (count == kFlightsTogether) completeRows();
    }
  }
  completeRows();
}

// Completes the trees that the solver has worked on, after Bullet has moved them.
void completeTrees(const btCollisionWorld& world, AmbientBodies& bodies, double time_step) {
  if (bodies.trees.world() != &world) return;
  forEachTree(bodies.trees, [&](AmbientTree& tree) { completeTree(tree, bodies, time_step); });
  for (const auto& tree : bodies.trees.all()) tree->step.outcome = Outcome::kNotSolved;
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

// Wakes the sleeping bodies and links whose mass was changed: it is another load. Models without a
// mass are of a body that has none that is physical.
void wakeReloaded(const btCollisionWorld& world, const AmbientBodies& bodies) {
  const btCollisionObjectArray& objects = world.getCollisionObjectArray();
  for (int i = 0; bodies.size() > 0 && i < objects.size(); ++i) {
    if (objects[i]->getActivationState() != ISLAND_SLEEPING) continue;
    const AmbientBody* ambient = bodies.find(objects[i]);
    if (!ambient || !ambient->isInFluid() || objects[i]->isStaticOrKinematicObject()) continue;
    if (ambient->models->inverse_mass.mass > 0 &&
        isModelStale(*ambient, inverseMassOf(*ambient->body)))
      objects[i]->activate();
  }
  forEachTreeIn(world, bodies.trees, [](const AmbientTree& tree) {
    if (!isAsleep(*tree.multi_body)) return;
    for (const auto& link : tree.links)
      if (!(link->mass == inverseMassOf(*tree.multi_body, link->link)))
        return wake(*tree.multi_body);
  });
}

// Wakes the followers that the world still has: others may have been destroyed.
void wakeFollowers(const btCollisionWorld& world, const AmbientBodies& bodies) {
  forEachIn(world, bodies, [](const AmbientBody& ambient) {
    if (ambient.def->follow_regions) wake(ambient);
  });
}

}  // namespace

// In two substeps in a row: another action may have woken the body after the solver's turn.
bool FluidAction::isSolverMissing(const btCollisionWorld& world) {
  const unsigned solved = bodies_.solved;
  const bool is_missing = std::exchange(solved_, solved) == solved &&
                          (bodies_.size() > 0 || !bodies_.trees.empty()) &&
                          hasAwakeBody(world, bodies_);
  return std::exchange(was_missing_, is_missing) && is_missing;
}

void FluidAction::updateAction(btCollisionWorld* world, btScalar time_step) {
  world_ = world;
  completeBodies(*world, bodies_, static_cast<double>(time_step));
  completeTrees(*world, bodies_, static_cast<double>(time_step));
  if (std::isfinite(time_step)) {
    bodies_.regions.time += static_cast<double>(time_step);
  } else if (bodies_.size() > 0 || !bodies_.trees.empty() || !bodies_.regions.empty()) {
    bodies_.warnings.warnOnce(Warning::kDuration);
    forgetBrokenImpulses(*world);
  }
  if (bodies_.has_vessels) findBodiesInHolds(*world, bodies_);
  if (std::exchange(bodies_.regions.has_changed, false)) wakeFollowers(*world, bodies_);
  wakeReloaded(*world, bodies_);
  if (isSolverMissing(*world)) {
    const bool has_multibodies = dynamic_cast<const btMultiBodyDynamicsWorld*>(world);
    bodies_.warnings.warnOnce(has_multibodies ? Warning::kNoMultiBodySolver : Warning::kNoSolver);
  }
  attachLater(*world);
}

void FluidAction::attachLater(btCollisionWorld& world) {
  for (const auto& attachment : followed_) attachment->update(world);
}

void FluidAction::follow(std::unique_ptr<WorldAttachment> attachment) {
  followed_.push_back(std::move(attachment));
}

void FluidAction::debugDraw(btIDebugDraw* drawer) {
  if (!drawer || !world_ || !drawing_.drawsAnything()) return;
  const FluidRegions& regions = bodies_.regions;
  const auto* dynamics = dynamic_cast<const btDynamicsWorld*>(world_);
  if (drawing_.water_surface && dynamics) {
    const btVector3 gravity = const_cast<btDynamicsWorld*>(dynamics)->getGravity();
    RegionCall call(regions);
    for (const auto& [id, entry] : regions.all())
      drawSurface(entry.region, gravity, regions.time, drawing_, *drawer);
  }
  const btCollisionObjectArray& objects = world_->getCollisionObjectArray();
  for (int i = 0; i < objects.size(); ++i) {
    const AmbientBody* ambient = bodies_.find(objects[i]);
    if (ambient && ambient->isInFluid() && !objects[i]->isStaticOrKinematicObject()) {
      drawFluid(*ambient, motionOf(*ambient->body), drawing_, *drawer);
    }
  }
  forEachTreeIn(*world_, bodies_.trees, [&](AmbientTree& tree) {
    computeLinkPosesNow(tree);
    for (const auto& link : tree.links)
      if (link->ambient.isInFluid() && link->mass.mass > 0)
        drawFluid(link->ambient, link->now, drawing_, *drawer);
  });
}

AMBIENT_END
