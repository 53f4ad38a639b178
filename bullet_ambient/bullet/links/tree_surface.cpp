#include <algorithm>
#include <cmath>
#include <limits>

#include "bullet_ambient/bullet/links/tree_step.h"
#include "bullet_ambient/bullet/members/tree_state.h"
#include "bullet_ambient/immersed/floating_state.h"

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

// Returns the gyroscopic torque about the axis of a body of revolution, along that axis, in a
// motion of a link that is frozen.
Vector3 torqueOnSpin(const AmbientLink& link, const Vector6& x) {
  const Vector3& axis = link.ambient.surface()->still_axis_B;
  if (axis.isZero(0)) return axis;
  return axis.dot(gyroscopicWrench(pairOfTwist(*link.frozen, x)).torque) * axis;
}

// Lets up to kFlightsTogether links pass the surface side by side, which have come to where a step
// ends, with the twists that they have there alone. Writes the impulses that change these.
// Returns the energy removed [J].
double changeTogether(AmbientLink* const* links, BodyMovedByRows* moved, int count, double duration,
                      std::vector<Wrench>& impulses) {
  Vector6 before[kFlightsTogether];
  for (int i = 0; i < count; ++i) before[i] = moved[i].twist.twist;
  applyAddedMassChanges(moved, count, duration);
  double energy_removed = 0;
  for (int i = 0; i < count; ++i) {
    AmbientLink& link = *links[i];
    const BoundedTwist& after = moved[i].twist;
    FloatingState& floating = *link.ambient.floating;
    const Vector3 on_spin = torqueOnSpin(link, before[i]);
    link.frozen.freeze(link.ambient);
    floating.waves = floating.waves_with_rows;
    // The water leaves a body of revolution its spin, docs/theory.md eq. (66a).
    Wrench& impulse = impulses[link.link + 1];
    impulse = impulseOf(link, after.twist - before[i]);
    impulse.torque = link.ambient.surface()->withoutStill(impulse.torque) - duration * on_spin;
    energy_removed += after.energy_removed;
  }
  return energy_removed;
}

}  // namespace

bool isAtSurface(const AmbientTree& tree) noexcept {
  bool is_at = false;
  forEachAtSurface(tree, [&is_at](const AmbientLink&, int) { is_at = true; });
  return is_at;
}

void addInflow(AmbientTree& tree) noexcept {
  std::fill(tree.step.impulses.begin(), tree.step.impulses.end(), Wrench{});
  bool has_come = false;
  forEachAtSurface(tree, [&](AmbientLink& link, int i) {
    const VesselState* const vessel = link.ambient.vessel.get();
    if (!vessel || vessel->change_B.isZero(0)) return;
    tree.step.impulses[i] = impulseOf(link, vessel->change_B);
    has_come = true;
  });
  if (has_come) addResponse(tree, tree.step.start);
}

void kickAtSurface(AmbientTree& tree, double duration, Warnings& warnings) noexcept {
  TreeStep& step = tree.step;
  step.surface.time = duration;
  step.surface.has_flown = false;
  std::fill(step.impulses.begin(), step.impulses.end(), Wrench{});
  forEachAtSurface(tree, [&](AmbientLink& link, int i) {
    step.impulses[i] = impulseOf(link, kickByWavesAndWind(link.ambient, link.now.state, duration));
  });
  step.meets_surface = addResponse(tree, step.start);
  forEachAtSurface(
      tree, [&](AmbientLink& link, int) { warnOfShortPeriod(link.ambient, duration, warnings); });
}

void stiffenForRows(AmbientTree& tree) noexcept {
  forEachAtSurface(tree, [&](AmbientLink& link, int) {
    const Flotation& flotation = link.ambient.flotation();
    link.frozen.stiffen(flotation, flotation.modes, tree.step.surface.time);
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
    const Flotation& flotation = link.ambient.flotation();
    link.hydrostatics =
        link.frozen.floatAt(link.ambient, {dynamics.rotation(i), dynamics.position(i)}, half);
    link.frozen.stiffen(flotation, modesOfWaterplane(flotation), surface.time);
  });
}

double arriveAtSurface(AmbientTree& tree) noexcept {
  TreeStep& step = tree.step;
  const double duration = step.surface.time;
  computeLinkPoses(tree, step.end);
  const LinkDynamics& dynamics = tree.flight.dynamics();
  std::fill(step.impulses.begin(), step.impulses.end(), Wrench{});
  double energy_removed = 0;
  int count = 0;
  AmbientLink* links[kFlightsTogether];
  BodyMovedByRows moved[kFlightsTogether];
  const auto arrive = [&] {
    energy_removed += changeTogether(links, moved, count, duration, step.impulses);
    count = 0;
  };
  forEachAtSurface(tree, [&](AmbientLink& link, int i) {
    links[count] = &link;
    BodyMovedByRows& of_link = moved[count++];
    of_link.body = &link.ambient;
    of_link.pose = {dynamics.rotation(i), dynamics.position(i)};
    of_link.twist = {endTwist(dynamics, i, link.ambient.medium, duration)};
    of_link.hydrostatics = step.surface.has_flown ? &link.hydrostatics : nullptr;
    if (count == kFlightsTogether) arrive();
  });
  if (count > 0) arrive();
  return addResponse(tree, step.end) ? energy_removed : 0;
}

namespace {

// True if the fluid above the surface loads the link and moves relative to the water.
bool hasWind(const AmbientBody& ambient) {
  return ambient.surface()->loads_above.loads &&
         ambient.floating->velocity_above != ambient.medium.velocity;
}

// True if a torque, a joint force or an accelerating flow acts on a link.
bool isDriven(const Link& link) {
  const auto& forces = link.joint_force;
  return link.surroundings.hasTorque() ||
         std::any_of(forces.begin(), forces.end(), [](double force) { return force != 0; }) ||
         (link.model && !link.surroundings.ambient_acceleration.isZero(0));
}

// True if nothing but weight and water moves a tree, in one flow that it can follow.
bool isLeftToWater(AmbientTree& tree) {
  bool has_wind = false;
  forEachAtSurface(
      tree, [&](const AmbientLink& link, int) { has_wind = has_wind || hasWind(link.ambient); });
  const auto& links = tree.tree.links;
  return !has_wind && std::none_of(links.begin(), links.end(), isDriven) &&
         findFlow(tree.tree, tree.step.surface.start, tree.step.spare);
}

// Returns twice the kinetic energy of `u` relative to the flow [J], and leaves the velocity
// relative to the flow in `step.spare`.
double twiceKinetic(AmbientTree& tree, const CoordinatesIn& u) {
  Coordinates& x = tree.step.spare;
  x = u;
  x.segment<3>(3) -= flowAround(tree.tree);
  return tree.flight.dynamics().normSquared(x);
}

// Returns the potential energy at the pose of the dynamics [J], with positions relative to
// `origin_W`. Adds of_water(AmbientBody&, index in the tree) for each link at a surface: the energy
// of water and waves.
template <class OfWater>
double potentialEnergy(const AmbientTree& tree, const Vector3& origin_W, const OfWater& of_water) {
  const LinkDynamics& dynamics = tree.flight.dynamics();
  double sum = 0;
  for (int i = 0; i < tree.tree.size(); ++i) {
    const Link& link = tree.tree.links[i];
    if (!link.model) sum -= link.surroundings.applied.force.dot(dynamics.position(i) - origin_W);
  }
  for (const auto& ambient_link : tree.links) {
    const int i = ambient_link->link + 1;
    const AmbientBody& ambient = ambient_link->ambient;
    const Link& link = tree.tree.links[i];
    if (!link.model) continue;
    const SurfaceModel* surface = ambient.surface();
    sum += potentialEnergy(surface ? surface->above : *link.model, link.surroundings,
                           {dynamics.rotation(i), dynamics.position(i) - origin_W},
                           surface ? of_water(ambient, i) : 0);
  }
  return sum;
}

// Returns the energy rho g W of docs/theory.md eq. (64) at the last pose of a link, and that of its
// waves [J].
double energyOfWater(const AmbientBody& ambient, int) {
  const Flotation& flotation = ambient.flotation();
  return hydrostaticEnergy(wetVolume(*ambient.surface(), flotation), flotation.plane) +
         ambient.floating->waves.energy() + (ambient.vessel ? ambient.vessel->sloshing_energy : 0);
}

// Returns the largest change of the energy by rounding of Bullet's poses [J].
double roundingOfEnergy(const AmbientTree& tree) {
  constexpr double kRounding = 64 * static_cast<double>(std::numeric_limits<btScalar>::epsilon());
  double sum = 0;
  forEachAtSurface(tree, [&](const AmbientLink& link, int i) {
    const SurfaceModel& model = *link.ambient.surface();
    const double weight =
        (model.below.mass + model.below.displaced_mass) * link.ambient.floating->plane_W.gravity;
    sum += weight * (model.radius + tree.flight.dynamics().position(i).norm());
  });
  return kRounding * sum;
}

// Returns the origin of displacements, which moves with the flow, `time` after the start.
Vector3 originAfter(const AmbientTree& tree, double time) {
  return tree.step.surface.origin_W + time * flowAround(tree.tree);
}

}  // namespace

void keepEnergy(AmbientTree& tree) noexcept {
  SurfaceStep& surface = tree.step.surface;
  surface.is_bound = isLeftToWater(tree);
  if (!surface.is_bound) return;
  surface.origin_W = tree.flight.dynamics().position(0);
  surface.rounding = roundingOfEnergy(tree);
  surface.energy = twiceKinetic(tree, surface.start) / 2 +
                   potentialEnergy(tree, surface.origin_W, energyOfWater);
}

bool mayGainEnergy(AmbientTree& tree, double duration) noexcept {
  if (!tree.step.surface.is_bound) return false;
  LinkDynamics& dynamics = tree.flight.dynamics();
  const Vector3 flow = flowAround(tree.tree);
  dynamics.setVelocity(tree.step.moved);
  bool is_stiff = false;
  double most = 0;  // right-hand side of eq. (81b) [J]
  forEachAtSurface(tree, [&](const AmbientLink& link, int i) {
    const AmbientBody& ambient = link.ambient;
    const SurfaceModel& model = *ambient.surface();
    const SurfacePlane& plane = ambient.floating->plane_W;
    const Twist& twist = dynamics.twist(i);
    const double speed =
        (dynamics.rotation(i) * twist.linear - flow).norm() + model.radius * twist.angular.norm();
    most += errorOfBuoyancy(model, plane, speed, duration);
    is_stiff = is_stiff || duration * ambient.flotation().frequency > kLongestPhase;
  });
  return is_stiff || twiceKinetic(tree, tree.step.end) < 2 * most;
}

bool hasGainedEnergy(const AmbientTree& tree, double since_start) noexcept {
  const SurfaceStep& surface = tree.step.surface;
  const LinkDynamics& dynamics = tree.flight.dynamics();
  const double potential = potentialEnergy(
      tree, originAfter(tree, since_start), [&](const AmbientBody& ambient, int link) {
        const FrameOffset pose{dynamics.rotation(link), dynamics.position(link)};
        return hydrostaticEnergyAt(ambient, pose, surface.time) +
               ambient.floating->waves_with_rows.energy() +
               (ambient.flotation().inside_F ? ambient.vessel->before_rows.energy : 0);
      });
  return potential > surface.energy + surface.rounding;
}

void keepWithinReach(AmbientTree& tree) noexcept {
  TreeStep& step = tree.step;
  const double h = step.surface.time;
  if (!mayGainEnergy(tree, h)) return;
  LinkDynamics& dynamics = tree.flight.dynamics();
  const Vector3 flow = flowAround(tree.tree);
  const auto scale = [&flow](double part, Coordinates& u) {
    u *= part;
    u.segment<3>(3) += (1 - part) * flow;
  };
  const auto reaches = [&](double part) {
    step.spare = step.moved;
    scale(part, step.spare);
    movePose(tree.tree, step.pose, step.spare, h, step.surface.middle);
    dynamics.moveTo(step.surface.middle);
    return !hasGainedEnergy(tree, h);
  };
  const double part = reaches(1) ? 1 : lastPart(reaches);
  dynamics.moveTo(step.pose);
  if (part == 1) return;
  dynamics.setVelocity(step.moved);
  forEachAtSurface(tree, [&](AmbientLink& link, int i) {
    brakeWithRows(link.ambient, endTwist(dynamics, i, link.ambient.medium, 0), part, h);
  });
  scale(part, step.end);
  scale(part, step.moved);
  step.turning *= part;
  ++tree.links.front()->ambient.counters.halted;
}

namespace {

// Scales `step.end` relative to the flow, so that the energy does not exceed the one that
// keepEnergy() stored. `duration` of the step [s]. Returns the energy removed [J].
double boundSurfaceEnergy(AmbientTree& tree, double duration) {
  TreeStep& step = tree.step;
  if (!step.surface.is_bound) return 0;
  const double potential = potentialEnergy(tree, originAfter(tree, duration), energyOfWater);
  const double has = twiceKinetic(tree, step.end);
  const double allowed = 2 * std::max(0.0, step.surface.energy + step.surface.rounding - potential);
  if (!(has > allowed)) return 0;
  step.end = std::sqrt(allowed / has) * step.spare;
  step.end.segment<3>(3) += flowAround(tree.tree);
  return (has - allowed) / 2;
}

}  // namespace

void applyAddedMassChange(AmbientTree& tree, double duration) noexcept {
  TreeStep& step = tree.step;
  if (!step.meets_surface) return;
  readPose(*tree.multi_body, step.pose);
  const double removed = arriveAtSurface(tree);
  const bool has_rows = step.outcome == Outcome::kRows || !step.change.isZero(0);
  countEnergyRemoved(removed + (has_rows ? 0 : boundSurfaceEnergy(tree, duration)), tree);
}

AMBIENT_END
