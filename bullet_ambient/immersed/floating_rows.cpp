#include <algorithm>
#include <cmath>
#include <optional>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/immersed/floating_state.h"
#include "bullet_ambient/immersed/vessel_step.h"
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

}  // namespace

StepModel::StepModel(const AmbientBody& ambient, double duration) noexcept {
  if (ambient.surface()) {
    freeze(ambient);
    stiffen(ambient.stand(), ambient.stand().modes, duration);
  } else {
    model_ = &ambient.model();
  }
}

StepModel::AtSurface::AtSurface(const SurfaceModel& at, const SurfaceStand& stand)
    : model(modelAtStand(at, stand)) {}

void StepModel::freeze(const AmbientBody& ambient) noexcept {
  model_ = &at_surface_.emplace(*ambient.surface(), ambient.stand()).model;
}

void StepModel::stiffen(const SurfaceStand& stand, const FloatingModes& modes,
                        double duration) noexcept {
  if (!(duration * stand.frequency > kLongestPhase)) return;
  const Matrix6 stiff = stiffInertia(stand, modes, duration);
  const Cholesky<6> factors(stiff);
  if (!factors.isPositive()) return;
  at_surface_->model.inertia = stiff;
  at_surface_->model.inverse_inertia = factors.inverse();
}

void warnOfShortPeriod(const AmbientBody& ambient, double duration,
                       Complaints& complaints) noexcept {
  const double frequency = ambient.stand().frequency;
  if (duration * frequency > kLongestPhase && duration * frequency > kPi / 2)
    complaints.sayShortPeriod(*ambient.def, frequency, duration);
}

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
    end = takeWind(model, stand, R.transpose() * wind_W, duration, end);
    countLoads(ambient, 1);
  }
  if (stand.inside_F) end = sloshForRows(ambient, now, duration, end);
  return end - x;
}

namespace {

/// Weight and buoyancy of a body, in B.
struct HydrostaticLoad {
  Vector6 lift;          ///< of the water
  Vector6 wrench;        ///< of both
  double potential = 0;  ///< of both [J]

  /// @param mass less that of the fluid above that the body displaces [kg]
  HydrostaticLoad(const SurfacePlane& plane, const WetVolume& wet, double mass)
      : lift(hydrostaticWrench(wet, plane).vector()), wrench(lift) {
    wrench.tail<3>() -= mass * plane.gravity * plane.normal;
    potential = hydrostaticEnergy(wet, plane) - mass * plane.gravity * plane.height;
  }
};

/// Place and HydrostaticLoad of a body where its step began, and the inverse of its inertia there.
struct BeforeRows {
  SurfacePlace place;
  HydrostaticLoad hydrostatics;
  SymmetricMatrix inverse;
};

/// One buoyancy has acted over the whole step, and the body has come to where it is another one:
/// gives back the energy that weight and water did not have, docs/theory.md eq. (68a). x_before, x:
/// twists; both have the inertia where the step began.
BoundedTwist withinPotential(const BeforeRows& before, const HydrostaticLoad& after,
                             double duration, const Vector6& x_before, const Vector6& x) {
  const double given = duration / 2 * before.hydrostatics.wrench.dot(x_before + x);
  const double excess = given - (before.hydrostatics.potential - after.potential);
  const Vector6 along = before.hydrostatics.lift + after.lift;
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
double weighingMass(const SurfaceModel& model) {
  return model.above.mass - model.above.displaced_mass;
}

HydrostaticLoad hydrostaticsAt(const SurfaceModel& model, const SurfacePlane& plane_B,
                               const WetVolume& wet) {
  return {plane_B, wet, weighingMass(model)};
}

// Returns weight and buoyancy of a body at its last stand.
HydrostaticLoad hydrostaticsOf(const AmbientBody& ambient) {
  const SurfaceModel& model = *ambient.surface();
  const SurfaceStand& stand = ambient.stand();
  return hydrostaticsAt(model, stand.plane, wetVolume(model, stand));
}

// Returns the same with the energy at a plane in B that differs from that of the stand by the
// rounding of Bullet's poses.
HydrostaticLoad hydrostaticsOf(const AmbientBody& ambient, const SurfacePlane& plane) {
  const SurfaceModel& model = *ambient.surface();
  const SurfaceStand& stand = ambient.stand();
  HydrostaticLoad hydrostatics = hydrostaticsOf(ambient);
  hydrostatics.potential +=
      energyOfRounding(model, stand, plane) -
      weighingMass(model) * plane.gravity * (plane.height - stand.plane.height);
  return hydrostatics;
}

// Returns the twist after the passage from `before` to the present stand of the body, at a pose B
// to W, over a time [s].
BoundedTwist passedFrom(const BeforeRows& before, AmbientBody& ambient, Axes axes,
                        const FrameOffset& pose, double duration, const Vector6& x) {
  const SurfaceModel& model = *ambient.surface();
  const SurfaceStand& after = ambient.stand();
  SurfacePlace place = before.place;
  const auto withWater = [&](const Vector6& twist) {
    if (!after.inside_F) return twist;
    return arriveWithWater(ambient, pose.rotation, pose.translation - wayOfWater(ambient, duration),
                           axes, twist, place.inertia);
  };
  if (axes == Axes::kLocked) {
    withWater(x);
    return scaledWithin(x, x.dot(after.inertia.full() * x), x.dot(before.place.inertia.full() * x));
  }
  const BoundedTwist moved = withinPotential(before, hydrostaticsOf(ambient), duration,
                                             ambient.floating->twist_before_rows, x);
  BoundedTwist end = passSurface(model, place, after, duration, withWater(moved.twist));
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
  return hydrostaticsAt(model, plane_B, wet).wrench;
}

void passWithRows(AmbientBody* const* bodies, const FrameOffset* poses, int count, Axes axes,
                  double duration, BoundedTwist* twists, const Vector6* falls) noexcept {
  AMBIENT_ASSERT(count > 0 && count <= kFlightsTogether);
  std::optional<BeforeRows> before[kFlightsTogether];
  for (int i = 0; i < count; ++i) {
    AmbientBody& ambient = *bodies[i];
    before[i] = BeforeRows{ambient.stand(),  // since standNow()
                           hydrostaticsOf(ambient, ambient.floating->plane_before_rows),
                           ambient.stand().inverse};
    if (falls) before[i]->hydrostatics.wrench = falls[i];
    moveStandTo(seenFrom(movedPlane(ambient, duration), poses[i]), *ambient.floating);
  }
  completeStandsOf(bodies, count);
  for (int i = 0; i < count; ++i) {
    AmbientBody& ambient = *bodies[i];
    ambient.floating->plane_W = movedPlane(ambient, duration);
    twists[i] = passedFrom(*before[i], ambient, axes, poses[i], duration, twists[i].twist);
  }
}

double hydrostaticEnergyAt(const AmbientBody& ambient, const FrameOffset& pose,
                           double duration) noexcept {
  const SurfaceModel& model = *ambient.surface();
  const SurfacePlane plane_B = seenFrom(movedPlane(ambient, duration), pose);
  return hydrostaticEnergy(wetVolumeAt(model, plane_B, waterOf(ambient)), plane_B);
}

}  // namespace ambient
