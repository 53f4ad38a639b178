#include "bullet_ambient/immersed/floating_state.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/motion/surface/body_waves.h"
#include "bullet_ambient/motion/surface/hold_exchange.h"
#include "bullet_ambient/motion/surface/stand_lanes.h"
#include "bullet_ambient/spatial/cholesky.h"

namespace ambient {
namespace {

// Returns the way of the water since the step began, after a time.
Vector3 wayOfWater(const AmbientBody& ambient, double time) {
  const Medium& water = ambient.medium;
  return time * water.velocity + time * time / 2 * water.acceleration;
}

// Returns the plane in W after a time since the step began: it moves with the water.
SurfacePlane movedPlane(const AmbientBody& ambient, double time) {
  SurfacePlane plane = ambient.floating->plane_W;
  plane.height += plane.normal.dot(wayOfWater(ambient, time));
  return plane;
}

// Returns the plane at the start of the step in B, at a pose.
SurfacePlane planeAt(const AmbientBody& ambient, const RigidState& state) {
  return seenFrom(ambient.floating->plane_W, state.orientation.toRotationMatrix(), state.position);
}

// Whether two planes are one but for a rounding of poses, relative to their place in W.
bool isNear(const SurfacePlane& a, const SurfacePlane& b, double size, double rounding) {
  return a.density == b.density && a.gravity == b.gravity && a.sides_F == b.sides_F &&
         (a.normal - b.normal).cwiseAbs().maxCoeff() <= rounding &&
         std::abs(a.height - b.height) <= rounding * size;
}

bool isSame(const SurfacePlane& a, const SurfacePlane& b) {
  return a.normal == b.normal && a.height == b.height && a.density == b.density &&
         a.gravity == b.gravity && a.sides_F == b.sides_F;
}

// Sets the plane of the stand to a plane in B.
void moveTo(const SurfacePlane& plane_B, FloatingState& floating) {
  if (floating.is_valid && isSame(floating.stand.plane, plane_B)) {
    floating.has_plane = true;
  } else {
    floating.setPlane(plane_B);
  }
}

// Sets the plane of the stand to that at a pose, unless they differ by the rounding of the pose
// only.
void takePlane(AmbientBody& ambient, const RigidState& state, double rounding) {
  constexpr double kRoundings = 64;
  FloatingState& floating = *ambient.floating;
  const SurfacePlane plane_B = planeAt(ambient, state);
  const double size = ambient.surface()->radius + state.position.norm();
  if (floating.has_plane && isNear(floating.stand.plane, plane_B, size, kRoundings * rounding))
    return;
  moveTo(plane_B, floating);
}

// Computes the stands of up to kFlightsTogether bodies for the planes that they have met.
void completeAll(AmbientBody* const* bodies, int count) {
  const SurfaceModel* models[kFlightsTogether] = {};
  SurfaceStand* stands[kFlightsTogether] = {};
  int made = 0;
  for (int i = 0; i < count; ++i) {
    FloatingState& floating = *bodies[i]->floating;
    if (floating.is_valid) continue;
    const SurfaceModel& model = *bodies[i]->surface();
    static_cast<SurfacePlace&>(floating.stand) =
        placeAt(model, floating.stand.plane, waterAtStand(*bodies[i]));
    floating.is_valid = true;
    models[made] = &model;
    stands[made++] = &floating.stand;
  }
  if (made > 0) completeStands(models, stands, made);
}

// Returns the model of a body with the inertia, displacement and loads of its stand.
BodyModel modelAt(const SurfaceModel& at, const SurfaceStand& stand) {
  BodyModel model = frozenAt(at, stand);
  const PartLoads& below = at.loads_below;
  if (!below.loads) return model;
  model.loads = below.loads;
  model.load_frame = below.frame;
  model.wet =
      WetPart{seenFrom(stand.plane, below.frame), wetShare(stand.immersion_F, at.shape->volume)};
  giveResistance(model, below.resistance);
  return model;
}

}  // namespace

bool hasSurface(const RegionSample& sample, const Vector3& gravity) noexcept {
  return gravity.norm() > 0 && (gravity - sample.below.acceleration).norm() > 0;
}

Vector3 leanOf(const RegionSample& sample, const Vector3& gravity) noexcept {
  return (gravity - sample.below.acceleration).dot(gravity.normalized()) * sample.tilt;
}

SurfacePlane planeNear(const Vector3& position, const RegionSample& sample,
                       const Vector3& gravity) noexcept {
  Vector3 felt = gravity - sample.below.acceleration;
  if (!sample.tilt.isZero(0)) felt += leanOf(sample, gravity);
  const Vector3 normal = -felt.normalized();
  const Vector3 above = position - sample.height * gravity.normalized();
  return {normal, normal.dot(above), sample.below.density - sample.above.density, felt.norm()};
}

namespace {

// Above and below a surface, holds are full of the fluid there. Returns where a body is as it is
// filled.
SurfaceSide withWater(const AmbientBody& ambient, const SurfaceModel& model, SurfaceSide side) {
  const HoldState* const water = waterOf(ambient);
  if (!water || side == SurfaceSide::kAt) return side;
  const bool is_as_around =
      side == SurfaceSide::kAbove ? areEmpty(*model.holds, water) : areFull(*model.holds, water);
  return is_as_around ? side : SurfaceSide::kAt;
}

}  // namespace

NearSurface nearSurface(const AmbientBody& ambient, const MotionView& now, const SurfaceKind& kind,
                        const RegionSample& sample, const Vector3& point_W,
                        double duration) noexcept {
  const Vector3& gravity = now.gravity;
  const int media = ambient.models->findSurface(kind);
  if (media < 0 || !hasSurface(sample, gravity))
    return {sample.isAbove() ? SurfaceSide::kAbove : SurfaceSide::kBelow};
  const SurfaceModel& model = ambient.models->surfaces[static_cast<std::size_t>(media)].model;
  const RigidState& state = now.state;
  const SurfacePlane plane_W = planeNear(point_W, sample, gravity);
  const double speed = (now.twist_W.linear - sample.below.velocity).norm();
  const double travel =
      duration * (speed + model.radius * state.twist.angular.norm() + duration * gravity.norm());
  const SurfacePlane plane_B =
      seenFrom(plane_W, state.orientation.toRotationMatrix(), state.position);
  return {withWater(ambient, model, sideOf(model, plane_B, travel)), media, plane_W};
}

void meetHolds(AmbientBody& ambient, const MotionView& now, const NearSurface& near) noexcept {
  if (near.media < 0 || std::exchange(ambient.vessel->is_known, true)) return;
  if (!ambient.def->holds.are_open) return;
  const SurfaceModel& model = ambient.models->surfaces[static_cast<std::size_t>(near.media)].model;
  const SurfacePlane plane_B = seenFrom(near.plane_W, now.rotation(), now.state.position);
  fillCoveredHolds(*model.holds, &ambient.vessel->changes, seenFrom(plane_B, model.fluid_frame),
                   ambient.vessel->holds.data());
}

SurfaceSide enterSurface(AmbientBody& ambient, const NearSurface& near, const RegionSample& sample,
                         const PoolSides& sides_F) noexcept {
  const bool is_cut = sides_F.count > 0 && near.side != SurfaceSide::kAbove;
  if (near.media < 0 || (near.side != SurfaceSide::kAt && !is_cut)) return near.side;
  if (ambient.surface_media != near.media) ambient.floating->is_valid = false;
  ambient.surface_media = near.media;
  FloatingState& floating = *ambient.floating;
  floating.plane_W = near.plane_W;
  floating.velocity_above = sample.above.velocity;
  if (!is_cut) return SurfaceSide::kAt;
  ambient.flow_along->sides_F = sides_F;
  floating.plane_W.sides_F = &ambient.flow_along->sides_F;
  ambient.floating->has_plane = ambient.floating->is_valid = false;  // its stand had other sides
  return SurfaceSide::kAt;
}

void standAt(AmbientBody* const* bodies, const RigidState* states, int count,
             double rounding) noexcept {
  AMBIENT_ASSERT(count > 0 && count <= kFlightsTogether);
  for (int i = 0; i < count; ++i) takePlane(*bodies[i], states[i], rounding);
  completeAll(bodies, count);
}

BodyModel modelNow(const AmbientBody& ambient, const MotionView& now) {
  const SurfaceModel* surface = ambient.surface();
  if (!surface) return ambient.model();
  WaterInside inside;
  return modelAt(
      *surface, standAtSurface(*surface, planeAt(ambient, now.state), {waterOf(ambient), &inside}));
}

const SurfaceStand& standNow(AmbientBody& ambient, const MotionView& now) noexcept {
  AmbientBody* const body = &ambient;
  standAt(&body, &now.state, 1, now.rounding);
  return ambient.stand();
}

namespace {

// Returns the twist in B relative to the water.
Vector6 twistInWater(const AmbientBody& ambient, const RigidState& state) {
  Twist relative = state.twist;
  relative.linear -= state.orientation.toRotationMatrix().transpose() * ambient.medium.velocity;
  return relative.vector();
}

}  // namespace

namespace {

// Returns a body with water in its holds at its stand.
WaterAt waterAt(const AmbientBody& ambient, const Matrix3& to_world, const Vector3& position_W) {
  return {*ambient.surface(), ambient.stand(), to_world, position_W};
}

// Lets water that has not sloshed yet begin, and finds its energy.
void beginSloshing(AmbientBody& ambient, const Matrix3& to_world, const Vector6& x) {
  VesselState& vessel = *ambient.vessel;
  vessel.sloshing_energy = 0;
  if (!ambient.stand().inside_F) return;
  Sloshing* const states = vessel.sloshing.now.data();
  const SloshingAt at = waterAt(ambient, to_world, {0, 0, 0}).sloshing();
  joinVessel(at, x, states);
  vessel.sloshing_energy = energyOfSloshing(at, states).sum();
}

// Takes the sloshing to the water that is there after some has passed. `energy`: of all that moves,
// before it [J].
void mixWater(AmbientBody& ambient, const Matrix3& to_world, const Vector6& x, double energy) {
  VesselState& vessel = *ambient.vessel;
  vessel.sloshing_energy = 0;
  Sloshing* const states = vessel.sloshing.now.data();
  if (!ambient.stand().inside_F) {
    std::fill(states, states + vessel.holds.size(), Sloshing{});
    return;
  }
  const SloshingAt at = waterAt(ambient, to_world, {0, 0, 0}).sloshing();
  mixSloshing(vessel.holds.data(), vessel.sloshing.later.data(), at, x, states);
  meetModes(at, energy, states);
  vessel.sloshing_energy = energyOfSloshing(at, states).sum();
}

// True if the water in a vessel sloshes so little that the vessel may sleep.
bool isNearlyLevel(const AmbientBody& ambient) {
  constexpr double kLittle = 1e-6;  // of the water's weight times the size of the vessel
  double volume = 0;
  for (const HoldState& hold : ambient.vessel->holds) volume += hold.volume;
  const SurfaceModel& model = *ambient.surface();
  const double weight = model.excess_density * volume * ambient.stand().plane.gravity;
  return ambient.vessel->sloshing_energy <= kLittle * weight * model.radius;
}

}  // namespace

void exchangeWater(AmbientBody& ambient, const MotionView& now, double duration) noexcept {
  constexpr double kStill = 1e-9;  // of a hold
  VesselState& vessel = *ambient.vessel;
  const SurfaceModel& model = *ambient.surface();
  const SurfaceStand& stand = standNow(ambient, now);
  const Vector6 x = twistInWater(ambient, now.state);
  const Matrix3 R = now.rotation();
  beginSloshing(ambient, R, x);
  const double twice_before = x.dot(stand.inertia.full() * x) + 2 * vessel.sloshing_energy;
  vessel.sloshing.later = vessel.sloshing.modes;  // before water passes
  const HoldSettings& settings = ambient.def->holds;
  const Passage passage{settings.are_open, duration, settings.atmosphere, &vessel.changes,
                        vessel.has_waves ? &vessel.rises : nullptr};
  const Matrix6 come =
      exchangeWater(*model.holds, stand.immersion_F.plane, passage, vessel.holds.data());
  vessel.change_B.setZero();
  bool has_changed = false;
  for (std::size_t i = 0; i < vessel.holds.size(); ++i) {
    HoldState& hold = vessel.holds[i];
    has_changed = has_changed || hold.change != 0;
    (hold.inflow > 0 ? hold.flooded : hold.drained) += std::abs(hold.inflow);
    if (std::abs(hold.change) > kStill * vessel.shape->holds[i].volume) ambient.may_rest = false;
  }
  if (has_changed) {
    ambient.floating->is_valid = false;
    AmbientBody* const body = &ambient;
    completeAll(&body, 1);
    mixWater(ambient, R, x, twice_before / 2);
    const Matrix6 come_B = model.excess_density * model.fluid_frame.inertiaToB(come);
    const Vector6 end = x - stand.inverse.full() * (come_B * x);
    const double most = std::max(0.0, twice_before - 2 * vessel.sloshing_energy);
    vessel.change_B = scaledWithin(end, end.dot(stand.inertia.full() * end), most).twist - x;
  }
  if (!isNearlyLevel(ambient)) ambient.may_rest = false;
}

double sloshingEnergyNow(const AmbientBody& ambient, const MotionView& now) {
  if (!ambient.vessel || !ambient.surface()) return 0;
  std::vector<Sloshing> states = ambient.vessel->sloshing.now;
  std::vector<HoldModes> modes(states.size());
  WaterInside inside;
  const SurfacePlace place = placeAt(*ambient.surface(), planeAt(ambient, now.state),
                                     {waterOf(ambient), &inside, modes.data()});
  if (!place.inside_F) return 0;
  const WaterAt at{*ambient.surface(), place, now.rotation(), now.centre()};
  joinVessel(at.sloshing(), twistInWater(ambient, now.state), states.data());
  return energyOfSloshing(at.sloshing(), states.data()).kinetic;
}

StepModel::StepModel(const AmbientBody& ambient, double duration) noexcept {
  if (ambient.surface()) {
    freeze(ambient);
    stiffen(ambient.stand(), ambient.stand().modes, duration);
  } else {
    model_ = &ambient.model();
  }
}

StepModel::AtSurface::AtSurface(const SurfaceModel& at, const SurfaceStand& stand)
    : model(modelAt(at, stand)) {}

void StepModel::freeze(const AmbientBody& ambient) noexcept {
  model_ = &at_surface_.emplace(*ambient.surface(), ambient.stand()).model;
}

void StepModel::stiffen(const SurfaceStand& stand, const FloatingModes& modes,
                        double duration) noexcept {
  if (!(duration * stand.swing > kLongestSwing)) return;
  const Matrix6 stiff = stiffInertia(stand, modes, duration);
  const Cholesky<6> factors(stiff);
  if (!factors.isPositive()) return;
  at_surface_->model.inertia = stiff;
  at_surface_->model.inverse_inertia = factors.inverse();
}

void warnOfCoarseSwing(const AmbientBody& ambient, double duration,
                       Complaints& complaints) noexcept {
  const double swing = ambient.stand().swing;
  if (duration * swing > kLongestSwing && duration * swing > kPi / 2)
    complaints.sayCoarseSwing(*ambient.def, swing, duration);
}

namespace {

// Lets the water in the holds slosh over a step in which rows move the body.
Vector6 sloshForRows(AmbientBody& ambient, const RigidState& now, double duration,
                     const Vector6& x) {
  VesselState& vessel = *ambient.vessel;
  VesselSloshing& sloshing = vessel.sloshing;
  const WaterAt at = waterAt(ambient, now.orientation.toRotationMatrix(), now.position);
  sloshing.moved = sloshing.now;
  joinVessel(at.sloshing(), x, sloshing.moved.data());
  const Vector6 end =
      exchangeSloshing(at.sloshing(), ambient.stand().inverse.full(),
                       ambient.def->holds.sloshing_damping, duration, x, sloshing.moved.data());
  vessel.before_rows = WaterLeft(at, sloshing.moved.data());
  return end;
}

}  // namespace

Vector6 kickByWavesAndWind(AmbientBody& ambient, const RigidState& now, double duration) noexcept {
  const SurfaceModel& model = *ambient.surface();
  const SurfaceStand& stand = ambient.stand();
  const Matrix3 R = now.orientation.toRotationMatrix();
  const Vector6 x = twistInWater(ambient, now);
  ambient.floating->twist_before_rows = x;
  ambient.floating->plane_before_rows = planeAt(ambient, now);
  WaveMemory& waves = ambient.floating->waves_with_rows;
  waves = ambient.floating->waves;
  Vector6 end = exchangeWaves(stand.modes, R, stand.inverse, duration, x, waves);
  end.head<3>() = x.head<3>() + model.withoutStill(end.head<3>() - x.head<3>());
  if (model.loads_above.loads) {
    const Vector3 wind_W = ambient.medium.velocity - ambient.floating->velocity_above;
    end = takeWind({model, stand, R.transpose() * wind_W, duration}, end);
    countLoads(ambient, 1);
  }
  if (stand.inside_F) end = sloshForRows(ambient, now, duration, end);
  return end - x;
}

std::optional<SurfacePlane> lastPlane(const AmbientBody& ambient) noexcept {
  if (!ambient.floating || !ambient.floating->has_plane) return std::nullopt;
  return ambient.stand().plane;
}

void restoreFloating(AmbientBody& ambient, const RigidState& now, int media) noexcept {
  FloatingState& floating = *ambient.floating;
  AMBIENT_ASSERT(ambient.floating->has_plane);
  ambient.surface_media = media;
  const SurfacePlane met = ambient.stand().plane;
  const Vector3 normal_W = now.orientation * met.normal;
  floating.plane_W = {normal_W, met.height + normal_W.dot(now.position), met.density, met.gravity};
  ambient.floating->setPlane(met);
  AmbientBody* const body = &ambient;
  completeAll(&body, 1);
}

namespace {

/// Weight and buoyancy of a body, in B.
struct Fall {
  Vector6 lift;          ///< of the water
  Vector6 wrench;        ///< of both
  double potential = 0;  ///< of both [J]

  /// @param mass less that of the fluid above that the body displaces [kg]
  Fall(const SurfacePlane& plane, const WetVolume& wet, double mass)
      : lift(hydrostaticWrench(wet, plane).vector()), wrench(lift) {
    wrench.tail<3>() -= mass * plane.gravity * plane.normal;
    potential = hydrostaticEnergy(wet, plane) - mass * plane.gravity * plane.height;
  }
};

/// Place and Fall of a body where its step began, and the inverse of its inertia there.
struct Departure {
  SurfacePlace place;
  Fall fall;
  SymmetricMatrix inverse;
};

/// One buoyancy has acted over the whole step, and the body has come to where it is another one:
/// gives back the energy that weight and water did not have, docs/theory.md eq. (68a). x_before, x:
/// twists; both have the inertia where the step began.
BoundedTwist withinPotential(const Departure& before, const Fall& after, double duration,
                             const Vector6& x_before, const Vector6& x) {
  const double given = duration / 2 * before.fall.wrench.dot(x_before + x);
  const double excess = given - (before.fall.potential - after.potential);
  const Vector6 along = before.fall.lift + after.lift;
  const double rate = along.dot(x);
  if (!(excess > 0) || rate == 0) return {x};
  const Vector6 response = before.inverse.full() * along;
  const double per_part = along.dot(response), square = rate * rate - 2 * per_part * excess;
  const double part =
      square > 0 ? 2 * excess / (std::abs(rate) + std::sqrt(square)) : std::abs(rate) / per_part;
  const double removed = part * (std::abs(rate) - part / 2 * per_part);
  return {x - std::copysign(part, rate) * response, removed};
}

// Returns the mass of a body less that of the fluid above that it displaces [kg].
double fallingMass(const SurfaceModel& model) {
  return model.above.mass - model.above.displaced_mass;
}

Fall fallAt(const SurfaceModel& model, const SurfacePlane& plane_B, const WetVolume& wet) {
  return {plane_B, wet, fallingMass(model)};
}

// Returns weight and buoyancy of a body at its last stand.
Fall fallOf(const AmbientBody& ambient) {
  const SurfaceModel& model = *ambient.surface();
  const SurfaceStand& stand = ambient.stand();
  return fallAt(model, stand.plane, wetVolume(model, stand));
}

// Returns the same with the energy at a plane in B that differs from that of the stand by the
// rounding of Bullet's poses.
Fall fallOf(const AmbientBody& ambient, const SurfacePlane& plane) {
  const SurfaceModel& model = *ambient.surface();
  const SurfaceStand& stand = ambient.stand();
  Fall fall = fallOf(ambient);
  fall.potential += energyOfRounding(model, stand, plane) -
                    fallingMass(model) * plane.gravity * (plane.height - stand.plane.height);
  return fall;
}

/// A pose B to W, relative to the water where the step began, and the time since then [s].
struct Arrival {
  Matrix3 to_world;
  Vector3 position_W;
  double duration;
};

// Lets the water in the holds come to the present stand of the body, and returns the twist after
// that.
Vector6 arriveWithWater(AmbientBody& ambient, const Arrival& arrival, Axes axes, const Vector6& x,
                        SymmetricMatrix& inertia) {
  VesselState& vessel = *ambient.vessel;
  Sloshing* const states = vessel.sloshing.moved.data();
  const WaterAt at = waterAt(ambient, arrival.to_world, arrival.position_W);
  Vector6 end = x;
  if (axes == Axes::kLocked)
    meetModes(at.sloshing(), vessel.before_rows.energy, states);
  else
    end = shiftWater(vessel.before_rows, at, x, inertia, states);
  std::swap(vessel.sloshing.now, vessel.sloshing.moved);
  vessel.sloshing_energy = energyOfSloshing(at.sloshing(), vessel.sloshing.now.data()).sum();
  return end;
}

// Returns the twist after the passage from `before` to the present stand of the body.
BoundedTwist passedFrom(const Departure& before, AmbientBody& ambient, Axes axes,
                        const Arrival& arrival, const Vector6& x) {
  const SurfaceModel& model = *ambient.surface();
  const SurfaceStand& after = ambient.stand();
  SurfacePlace place = before.place;
  const auto withWater = [&](const Vector6& twist) {
    if (!after.inside_F) return twist;
    return arriveWithWater(ambient, arrival, axes, twist, place.inertia);
  };
  if (axes == Axes::kLocked) {
    withWater(x);
    return scaledWithin(x, x.dot(after.inertia.full() * x), x.dot(before.place.inertia.full() * x));
  }
  const double duration = arrival.duration;
  const BoundedTwist moved =
      withinPotential(before, fallOf(ambient), duration, ambient.floating->twist_before_rows, x);
  BoundedTwist end = passSurface({model, place, after, duration}, withWater(moved.twist));
  end.energy_removed += moved.energy_removed;
  return end;
}

}  // namespace

Vector6 StepModel::floatAt(const AmbientBody& ambient, const FrameOffset& pose,
                           double time) noexcept {
  const SurfaceModel& model = *ambient.surface();
  const SurfacePlane plane_B = seenFrom(movedPlane(ambient, time), pose);
  const WetVolume wet = wetVolumeAt(model, plane_B, waterOf(ambient));
  displace(model, wet, at_surface_->model);
  return fallAt(model, plane_B, wet).wrench;
}

void passWithRows(AmbientBody* const* bodies, const FrameOffset* poses, int count, Axes axes,
                  double duration, BoundedTwist* twists, const Vector6* falls) noexcept {
  AMBIENT_ASSERT(count > 0 && count <= kFlightsTogether);
  std::optional<Departure> departures[kFlightsTogether];
  for (int i = 0; i < count; ++i) {
    AmbientBody& ambient = *bodies[i];
    departures[i] =
        Departure{ambient.stand(),  // since standNow()
                  fallOf(ambient, ambient.floating->plane_before_rows), ambient.stand().inverse};
    if (falls) departures[i]->fall.wrench = falls[i];
    moveTo(seenFrom(movedPlane(ambient, duration), poses[i]), *ambient.floating);
  }
  completeAll(bodies, count);
  for (int i = 0; i < count; ++i) {
    AmbientBody& ambient = *bodies[i];
    ambient.floating->plane_W = movedPlane(ambient, duration);
    const Arrival arrival{poses[i].rotation, poses[i].translation - wayOfWater(ambient, duration),
                          duration};
    twists[i] = passedFrom(*departures[i], ambient, axes, arrival, twists[i].twist);
  }
}

double hydrostaticEnergyAt(const AmbientBody& ambient, const FrameOffset& pose,
                           double duration) noexcept {
  const SurfaceModel& model = *ambient.surface();
  const SurfacePlane plane_B = seenFrom(movedPlane(ambient, duration), pose);
  return hydrostaticEnergy(wetVolumeAt(model, plane_B, waterOf(ambient)), plane_B);
}

bool mayRestAtSurface(AmbientBody& ambient, const MotionView& now) noexcept {
  return isStable(*ambient.surface(), standNow(ambient, now));
}

}  // namespace ambient
