#include "bullet_ambient/bullet/links/tree_surface.h"

#include <algorithm>

#include "bullet_ambient/bullet/links/tree_energy.h"
#include "bullet_ambient/bullet/links/tree_links.h"
#include "bullet_ambient/bullet/members/tree_state.h"
#include "bullet_ambient/immersed/surface_encounter.h"

AMBIENT_BEGIN
namespace {

Wrench impulseOf(const AmbientLink& link, const Vector6& change) {
  return Wrench::fromVector(link.frozen->inertia * change);
}

// Adds H^-1 sum of J_l^T impulses to u, eq. (81a). Returns false, and leaves u unchanged, if that
// is not finite.
bool addResponse(AmbientTree& tree, Coordinates& u) {
  LinkDynamics& dynamics = tree.flight.dynamics();
  dynamics.setPose(tree.step.pose);
  if (!dynamics.factor()) return false;
  dynamics.respond(tree.step.impulses, tree.step.spare);
  if (!tree.step.spare.allFinite()) return false;
  u += tree.step.spare;
  return true;
}

// Returns the twist of a link at the end of a step, relative to the water, in the link's frame.
Vector6 endTwist(const LinkDynamics& dynamics, int link, const Medium& water, double duration) {
  Twist twist = dynamics.twist(link);
  const Vector3 flow = water.velocity + duration * water.acceleration;
  twist.linear -= dynamics.rotation(link).transpose() * flow;
  return twist.vector();
}

// Up to kFlightsTogether links that have come to where a step ends, with the twists that they have
// there alone.
struct SurfaceArrivals {
  int count = 0;
  AmbientLink* links[kFlightsTogether] = {};
  AmbientBody* bodies[kFlightsTogether] = {};  // of the links
  FrameOffset poses[kFlightsTogether];         // of the links, to W
  Vector6 twists[kFlightsTogether];
  Vector6 falls[kFlightsTogether];  // AmbientLink::fall
};

// Lets the links pass the surface side by side, and writes the impulses that change their twists.
// Returns the energy removed [J].
double passTogether(const SurfaceArrivals& some, const SurfaceStep& step,
                    std::vector<Wrench>& impulses) {
  BoundedTwist after[kFlightsTogether];
  for (int i = 0; i < some.count; ++i) after[i].twist = some.twists[i];
  passWithRows(some.bodies, some.poses, some.count, Axes::kFree, step.time, after,
               step.has_flown ? some.falls : nullptr);
  double energy_removed = 0;
  for (int i = 0; i < some.count; ++i) {
    AmbientLink& link = *some.links[i];
    SurfaceEncounter& encounter = link.ambient.encounter();
    link.frozen.freeze(link.ambient);
    encounter.waves = encounter.waves_with_rows;
    impulses[link.link + 1] = impulseOf(link, after[i].twist - some.twists[i]);
    energy_removed += after[i].energy_removed;
  }
  return energy_removed;
}

}  // namespace

void kickAtSurface(AmbientTree& tree, const TreeTask& task) noexcept {
  TreeStep& step = tree.step;
  step.surface.time = task.duration;
  step.surface.has_flown = false;
  std::fill(step.impulses.begin(), step.impulses.end(), Wrench{});
  forEachAtSurface(tree, [&](AmbientLink& link, int i) {
    step.impulses[i] = impulseOf(link, kickByWavesAndWind(link.ambient, task.duration));
  });
  step.meets_surface = addResponse(tree, step.start);
  forEachAtSurface(tree, [&](AmbientLink& link, int) {
    warnOfCoarseSwing(link.ambient, task.duration, task.bodies.complaints);
  });
}

void stiffenForRows(AmbientTree& tree) noexcept {
  forEachAtSurface(tree, [&](AmbientLink& link, int) {
    const SurfaceStand& stand = link.ambient.stand();
    link.frozen.stiffen(stand, stand.modes, tree.step.surface.time);
  });
}

void floatInMiddle(AmbientTree& tree) noexcept {
  SurfaceStep& surface = tree.step.surface;
  const double half = surface.time / 2;
  surface.has_flown = true;
  LinkDynamics& dynamics = tree.flight.dynamics();
  movePose(tree.tree, tree.step.pose, tree.step.start, half, surface.middle);
  dynamics.moveTo(surface.middle);
  forEachAtSurface(tree, [&](AmbientLink& link, int i) {
    const SurfaceStand& stand = link.ambient.stand();
    link.fall =
        link.frozen.floatAt(link.ambient, {dynamics.rotation(i), dynamics.position(i)}, half);
    link.frozen.stiffen(stand, modesOfWaterplane(stand), surface.time);
  });
}

double arriveAtSurface(AmbientTree& tree) noexcept {
  TreeStep& step = tree.step;
  const double duration = step.surface.time;
  placeStandIns(tree, step.end);
  const LinkDynamics& dynamics = tree.flight.dynamics();
  std::fill(step.impulses.begin(), step.impulses.end(), Wrench{});
  double energy_removed = 0;
  SurfaceArrivals some;
  const auto arrive = [&] {
    energy_removed += passTogether(some, step.surface, step.impulses);
    some.count = 0;
  };
  forEachAtSurface(tree, [&](AmbientLink& link, int i) {
    some.links[some.count] = &link;
    some.bodies[some.count] = &link.ambient;
    some.poses[some.count] = {dynamics.rotation(i), dynamics.position(i)};
    some.falls[some.count] = link.fall;
    some.twists[some.count++] = endTwist(dynamics, i, link.ambient.medium, duration);
    if (some.count == kFlightsTogether) arrive();
  });
  if (some.count > 0) arrive();
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

AMBIENT_END
