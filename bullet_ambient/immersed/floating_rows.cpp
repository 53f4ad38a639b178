#include <algorithm>
#include <cmath>
#include <optional>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/immersed/floating_state.h"
#include "bullet_ambient/immersed/vessel_step.h"
#include "bullet_ambient/motion/rows/row_velocity.h"
#include "bullet_ambient/spatial/cholesky.h"
#include "bullet_ambient/spatial/rotation.h"

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
  ambient.floating->brake.setZero();
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

/// Place and HydrostaticLoad of a body where its step began, and its response to impulses there, in
/// B.
struct BeforeRows {
  SurfacePlace place;
  HydrostaticLoad hydrostatics;
  Matrix6 response;
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
  const Vector6 response = before.response * along;
  const double per_part = along.dot(response), square = rate * rate - 2 * per_part * excess;
  if (!(per_part > 0)) return {x};
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

// Returns K_eff^-1 of eq. (30) for a body at a stand, in B.
Matrix6 responseOf(const SurfaceStand& stand, const RowPassage& passage) {
  if (passage.factors.areFree()) return stand.inverse.full();
  const Matrix3& R = passage.pose.rotation;
  return rotateAxes(lockedInverse(rotateAxes(stand.inertia.full(), R), passage.factors),
                    R.transpose());
}

// Returns where a body is before its passage.
BeforeRows beforeRows(const RowPassage& passage) {
  const AmbientBody& ambient = *passage.body;
  const SurfaceStand& stand = ambient.stand();  // since standNow()
  BeforeRows before{stand, hydrostaticsOf(ambient, ambient.floating->plane_before_rows),
                    responseOf(stand, passage)};
  if (passage.hydrostatics) before.hydrostatics.wrench = *passage.hydrostatics;
  before.hydrostatics.wrench += ambient.floating->brake;
  return before;
}

// Lets a body pass from `before` to its present stand, over a time [s].
void passFrom(const BeforeRows& before, RowPassage& passage, double duration) {
  AmbientBody& ambient = *passage.body;
  const SurfaceStand& after = ambient.stand();
  SurfacePlace place = before.place;
  BoundedTwist& end = passage.twist;
  end = withinPotential(before, hydrostaticsOf(ambient), duration,
                        ambient.floating->twist_before_rows, end.twist);
  const double removed = end.energy_removed;
  Vector6 x = end.twist;
  if (after.inside_F)
    x = arriveWithWater(ambient, passage.pose.rotation,
                        passage.pose.translation - wayOfWater(ambient, duration),
                        passage.keeps_momentum, x, place.inertia);
  end = passage.keeps_momentum
            ? passSurface(*ambient.surface(), place, after, duration, x)
            : scaledWithin(x, x.dot(after.inertia.full() * x), x.dot(place.inertia.full() * x));
  end.energy_removed += removed;
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

double errorOfBuoyancy(const SurfaceModel& model, const SurfacePlane& plane, double speed,
                       double duration) noexcept {
  const double way = duration * speed;
  return kPi / 2 * plane.density * plane.gravity * model.radius * model.radius * way * way;
}

namespace {

// True if a body at the twist `end` in B may come to a place of more energy than it had in all.
bool mayReachTooFar(const AmbientBody& ambient, double duration, const Vector6& end) {
  const SurfaceModel& model = *ambient.surface();
  const SurfaceStand& stand = ambient.stand();
  if (duration * stand.frequency > kLongestPhase) return true;
  const double speed = end.tail<3>().norm() + model.radius * end.head<3>().norm();
  return end.dot(stand.inertia.full() * end) <
         2 * errorOfBuoyancy(model, stand.plane, speed, duration);
}

}  // namespace

double reachWithRows(AmbientBody& ambient, const RigidState& start, const Surroundings& s,
                     double duration, const Vector6& end) noexcept {
  constexpr double kRounding = 1e-12;
  const SurfaceModel& model = *ambient.surface();
  FloatingState& floating = *ambient.floating;
  const bool has_wind =
      model.loads_above.loads && floating.velocity_above != ambient.medium.velocity;
  if (has_wind || s.hasTorque() || !mayReachTooFar(ambient, duration, end)) return 1;
  const Matrix3 R = start.orientation.toRotationMatrix();
  const Vector3 pushed_W = s.applied.force - model.above.mass * s.gravity;
  const Vector3 spin_W = R * end.head<3>(), velocity_W = R * end.tail<3>();
  const auto energyAt = [&](double part) {
    const double t = part * duration;
    const Quaternion turned = rotationFromVector(t * spin_W) * start.orientation;
    const SurfacePlane plane_B =
        seenFrom(floating.plane_W, turned.toRotationMatrix(), start.position + t * velocity_W);
    const WetVolume wet = wetVolumeAt(model, plane_B, waterOf(ambient));
    return hydrostaticsAt(model, plane_B, wet).potential - t * velocity_W.dot(pushed_W);
  };
  const Vector6& x = floating.twist_before_rows;
  const double kinetic = x.dot(ambient.stand().inertia.full() * x) / 2;
  const double before = energyAt(0);
  const double most =
      before + kinetic + floating.waves.energy() - floating.waves_with_rows.energy();
  if (!(energyAt(1) - most > kRounding * (kinetic + std::abs(before)))) return 1;
  const double reached = lastPart([&](double part) { return !(energyAt(part) > most); });
  brakeWithRows(ambient, end, reached, duration);
  return reached;
}

void brakeWithRows(AmbientBody& ambient, const Vector6& x, double part, double duration) noexcept {
  ambient.floating->brake = (part - 1) / duration * (ambient.stand().inertia.full() * x);
}

void passWithRows(RowPassage* passages, int count, double duration) noexcept {
  AMBIENT_ASSERT(count > 0 && count <= kFlightsTogether);
  std::optional<BeforeRows> before[kFlightsTogether];
  AmbientBody* bodies[kFlightsTogether] = {};
  for (int i = 0; i < count; ++i) {
    bodies[i] = passages[i].body;
    before[i] = beforeRows(passages[i]);
    moveStandTo(seenFrom(movedPlane(*bodies[i], duration), passages[i].pose), *bodies[i]->floating);
  }
  completeStandsOf(bodies, count);
  for (int i = 0; i < count; ++i) {
    bodies[i]->floating->plane_W = movedPlane(*bodies[i], duration);
    passFrom(*before[i], passages[i], duration);
  }
}

double hydrostaticEnergyAt(const AmbientBody& ambient, const FrameOffset& pose,
                           double duration) noexcept {
  const SurfaceModel& model = *ambient.surface();
  const SurfacePlane plane_B = seenFrom(movedPlane(ambient, duration), pose);
  return hydrostaticEnergy(wetVolumeAt(model, plane_B, waterOf(ambient)), plane_B);
}

}  // namespace ambient
