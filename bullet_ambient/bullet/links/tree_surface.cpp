#include "bullet_ambient/bullet/links/tree_surface.h"

#include <algorithm>
#include <utility>

#include "bullet_ambient/bullet/links/tree_energy.h"
#include "bullet_ambient/bullet/links/tree_links.h"
#include "bullet_ambient/bullet/members/flight_coupling.h"
#include "bullet_ambient/bullet/members/tree_state.h"
#include "bullet_ambient/immersed/surface_encounter.h"

AMBIENT_BEGIN
namespace {

Wrench impulseOf(const AmbientBody& ambient, const Vector6& change) {
  return Wrench::fromVector(ambient.model.inertia * change);
}

// Adds H^-1 sum of J_l^T impulses to u. False if that is not finite, and u as it was.
bool addResponse(AmbientTree& tree, Coordinates& u) {
  LinkDynamics& dynamics = tree.flight.dynamics();
  dynamics.setPose(tree.step.pose);
  if (!dynamics.factor()) return false;
  dynamics.respond(tree.step.impulses, tree.step.spare);
  if (!tree.step.spare.allFinite()) return false;
  u += tree.step.spare;
  return true;
}

// Twist of a link at the end of a step, relative to the water there.
Vector6 endTwist(const LinkDynamics& dynamics, int link, const Medium& water, double duration) {
  Twist twist = dynamics.twist(link);
  const Vector3 flow = water.velocity + duration * water.acceleration;
  twist.linear -= dynamics.rotation(link).transpose() * flow;
  return twist.vector();
}

bool fliesAsBody(const AmbientTree& tree) {
  return tree.tree.size() == 1 && !tree.tree.links.front().keeps_velocity && isAtSurface(tree);
}

}  // namespace

void kickAtSurface(AmbientTree& tree, const TreeTask& task) noexcept {
  TreeStep& step = tree.step;
  step.surface.time = task.duration;
  std::fill(step.impulses.begin(), step.impulses.end(), Wrench{});
  forEachAtSurface(tree, [&](AmbientBody& ambient, int link) {
    step.impulses[link] = impulseOf(ambient, kickByWavesAndWind(ambient, task.duration));
  });
  step.meets_surface = addResponse(tree, step.start);
  forEachAtSurface(tree, [&](AmbientBody& ambient, int) {
    stiffenForRows(ambient, task.duration, task.bodies.complaints);
  });
}

double arriveAtSurface(AmbientTree& tree) noexcept {
  TreeStep& step = tree.step;
  const double duration = step.surface.time;
  placeStandIns(tree, step.end);
  const LinkDynamics& dynamics = tree.flight.dynamics();
  std::fill(step.impulses.begin(), step.impulses.end(), Wrench{});
  double energy_removed = 0;
  forEachAtSurface(tree, [&](AmbientBody& ambient, int link) {
    const Vector6 before = endTwist(dynamics, link, ambient.medium, duration);
    const BoundedTwist after = passWithRows(ambient, before, Axes::kFree, duration);
    freezeAsStood(ambient);
    ambient.encounter.waves = ambient.encounter.waves_with_rows;
    step.impulses[link] = impulseOf(ambient, after.twist - before);
    energy_removed += after.energy_removed;
  });
  return addResponse(tree, step.end) ? energy_removed : 0;
}

void passSurface(AmbientTree& tree, const TreeTask& task) noexcept {
  TreeStep& step = tree.step;
  if (!step.meets_surface) return;
  readPose(*tree.multi_body, step.pose);
  const double removed = arriveAtSurface(tree);
  const bool has_rows = step.outcome == TreeOutcome::kRows || !step.change.isZero(0);
  countEnergyRemoved(removed + (has_rows ? 0 : boundEnergy(tree, task.duration)), tree);
}

bool flyAsBody(AmbientTree& tree, const TreeTask& task) noexcept {
  if (!fliesAsBody(tree)) return false;
  TreeStep& step = tree.step;
  placeStandIns(tree, step.start);
  AmbientLink& base = *tree.links.front();
  const Wrench applied = tree.flight.dynamics().appliedWrench(0);
  base.stand_in.clearForces();
  base.stand_in.applyCentralForce(toBullet(applied.force));
  base.stand_in.applyTorque(toBullet(applied.torque));
  AmbientBody* const bodies[] = {&base.ambient};
  Twist change_W;
  const FlightMemory memory = base.ambient.memory;
  const SurfaceEncounter encounter = base.ambient.encounter;
  beginFlights(bodies, 1, task.duration, &change_W);
  const FlightEnd& end = base.ambient.outcome.flight;
  const bool has_flown =
      std::exchange(base.ambient.outcome.kind, Outcome::kNotMet) == Outcome::kFlown;
  if (has_flown) {
    step.moved = stack(end.effective_W.angular, end.effective_W.linear);
    step.end = stack(end.twist_W.angular, end.twist_W.linear);
  }
  if (!has_flown || turnsTooFastForBullet(tree.tree, step.moved, task.duration)) {
    base.ambient.memory = memory;
    base.ambient.encounter = encounter;
    return false;
  }
  base.ambient.left_W = end.twist_W;
  if (end.is_too_long) task.bodies.complaints.sayTooLong(base.ambient.def);
  return true;
}

AMBIENT_END
