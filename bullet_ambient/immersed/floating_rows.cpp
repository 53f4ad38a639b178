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

// Returns the displacement of the water since the step began, after a time.
Vector3 displacementOfWater(const AmbientBody& ambient, double time) {
  const Medium& water = ambient.medium;
  return time * water.velocity + time * time / 2 * water.acceleration;
}

// Returns the plane in W after a time since the step began: it moves with the water.
SurfacePlane movedPlane(const AmbientBody& ambient, double time) {
  SurfacePlane plane = ambient.floating->plane_W;
  plane.height += plane.normal.dot(displacementOfWater(ambient, time));
  return plane;
}

}  // namespace

StepModel::StepModel(const AmbientBody& ambient, double duration) noexcept {
  if (ambient.surface()) {
    freeze(ambient);
    stiffen(ambient.flotation(), ambient.flotation().modes, duration);
  } else {
    model_ = &ambient.model();
  }
}

StepModel::AtSurface::AtSurface(const SurfaceModel& at, const Flotation& flotation)
    : model(modelAtFlotation(at, flotation)) {}

void StepModel::freeze(const AmbientBody& ambient) noexcept {
  model_ = &at_surface_.emplace(*ambient.surface(), ambient.flotation()).model;
}

void StepModel::stiffen(const Flotation& flotation, const FloatingModes& modes,
                        double duration) noexcept {
  if (!(duration * flotation.frequency > kLongestPhase)) return;
  const Matrix6 stiff = stiffInertia(flotation, modes, duration);
  const Cholesky<6> factors(stiff);
  if (!factors.isPositive()) return;
  at_surface_->model.inertia = stiff;
  at_surface_->model.inverse_inertia = factors.inverse();
}

void warnOfShortPeriod(const AmbientBody& ambient, double duration, Warnings& warnings) noexcept {
  const double frequency = ambient.flotation().frequency;
  if (duration * frequency > kLongestPhase && duration * frequency > kPi / 2)
    warnings.warnOfShortPeriod(*ambient.def, frequency, duration);
}

Vector6 kickByWavesAndWind(AmbientBody& ambient, const RigidState& now, double duration) noexcept {
  const SurfaceModel& model = *ambient.surface();
  const Flotation& flotation = ambient.flotation();
  const Matrix3 R = now.orientation.toRotationMatrix();
  const Vector6 x = twistInWater(ambient, now);
  ambient.floating->twist_before_rows = x;
  ambient.floating->plane_before_rows = planeAt(ambient, now);
  ambient.floating->brake.setZero();
  WaveMemory& waves = ambient.floating->waves_with_rows;
  waves = ambient.floating->waves;
  Vector6 end = exchangeWaves(flotation.modes, R, flotation.inverse, duration, x, waves);
  end.head<3>() = x.head<3>() + model.withoutStill(end.head<3>() - x.head<3>());
  if (model.loads_above.loads) {
    const Vector3 wind_W = ambient.medium.velocity - ambient.floating->velocity_above;
    end = kickByWind(model, flotation, R.transpose() * wind_W, duration, end);
    countLoads(ambient, 1);
  }
  if (flotation.inside_F) end = sloshForRows(ambient, now, duration, end);
  return end - x;
}

namespace {

// Returns the mass of a body less that of the fluid above that it displaces [kg].
double weighingMass(const SurfaceModel& model) {
  return model.above.mass - model.above.displaced_mass;
}

/// Weight and buoyancy of a body, in B.
struct HydrostaticLoad {
  Vector6 lift;          ///< of the water
  Vector6 wrench;        ///< of both
  double potential = 0;  ///< of both [J]

  HydrostaticLoad(const SurfaceModel& model, const SurfacePlane& plane, const WetVolume& wet)
      : lift(hydrostaticWrench(wet, plane).vector()), wrench(lift) {
    const double mass = weighingMass(model);
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
  const double mobility = along.dot(response), square = rate * rate - 2 * mobility * excess;
  if (!(mobility > 0)) return {x};
  const double part =
      square > 0 ? 2 * excess / (std::abs(rate) + std::sqrt(square)) : std::abs(rate) / mobility;
  const double removed = part * (std::abs(rate) - part / 2 * mobility);
  return {x - std::copysign(part, rate) * response, removed};
}

// Returns weight and buoyancy of a body at its last flotation.
HydrostaticLoad hydrostaticsOf(const AmbientBody& ambient) {
  const SurfaceModel& model = *ambient.surface();
  const Flotation& flotation = ambient.flotation();
  return {model, flotation.plane, wetVolume(model, flotation)};
}

// Returns the same with the energy at a plane in B that differs from that of the flotation by the
// rounding of Bullet's poses.
HydrostaticLoad hydrostaticsOf(const AmbientBody& ambient, const SurfacePlane& plane) {
  const SurfaceModel& model = *ambient.surface();
  const Flotation& flotation = ambient.flotation();
  HydrostaticLoad hydrostatics = hydrostaticsOf(ambient);
  hydrostatics.potential +=
      energyOfRounding(model, flotation, plane) -
      weighingMass(model) * plane.gravity * (plane.height - flotation.plane.height);
  return hydrostatics;
}

// Returns K_eff^-1 of eq. (30) for a body at a flotation, in B.
Matrix6 responseOf(const Flotation& flotation, const BodyMovedByRows& moved) {
  if (moved.factors.areFree()) return flotation.inverse.full();
  const Matrix3& R = moved.pose.rotation;
  return rotateAxes(lockedInverse(rotateAxes(flotation.inertia.full(), R), moved.factors),
                    R.transpose());
}

// Returns where a body is before its added mass changes.
BeforeRows beforeRows(const BodyMovedByRows& moved) {
  const AmbientBody& ambient = *moved.body;
  const Flotation& flotation = ambient.flotation();  // since flotationNow()
  BeforeRows before{flotation, hydrostaticsOf(ambient, ambient.floating->plane_before_rows),
                    responseOf(flotation, moved)};
  if (moved.hydrostatics) before.hydrostatics.wrench = *moved.hydrostatics;
  before.hydrostatics.wrench += ambient.floating->brake;
  return before;
}

// Changes the added mass of a body from `before` to its present flotation, over a time [s].
void changeFrom(const BeforeRows& before, BodyMovedByRows& moved, double duration) {
  AmbientBody& ambient = *moved.body;
  const Flotation& after = ambient.flotation();
  SurfacePlace place = before.place;
  BoundedTwist& end = moved.twist;
  end = withinPotential(before, hydrostaticsOf(ambient), duration,
                        ambient.floating->twist_before_rows, end.twist);
  const double removed = end.energy_removed;
  Vector6 x = end.twist;
  if (after.inside_F)
    x = arriveWithWater(ambient, moved.pose.rotation,
                        moved.pose.translation - displacementOfWater(ambient, duration),
                        moved.keeps_momentum, x, place.inertia);
  end = moved.keeps_momentum
            ? applyAddedMassChange(*ambient.surface(), place, after, duration, x)
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
  return HydrostaticLoad(model, plane_B, wet).wrench;
}

double errorOfBuoyancy(const SurfaceModel& model, const SurfacePlane& plane, double speed,
                       double duration) noexcept {
  const double path = duration * speed;
  return kPi / 2 * plane.density * plane.gravity * model.radius * model.radius * path * path;
}

namespace {

// True if a body at the twist `end` in B may come to a place of more energy than it had in all.
bool mayReachTooFar(const AmbientBody& ambient, double duration, const Vector6& end) {
  const SurfaceModel& model = *ambient.surface();
  const Flotation& flotation = ambient.flotation();
  if (duration * flotation.frequency > kLongestPhase) return true;
  const double speed = end.tail<3>().norm() + model.radius * end.head<3>().norm();
  return end.dot(flotation.inertia.full() * end) <
         2 * errorOfBuoyancy(model, flotation.plane, speed, duration);
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
    return HydrostaticLoad(model, plane_B, wet).potential - t * velocity_W.dot(pushed_W);
  };
  const Vector6& x = floating.twist_before_rows;
  const double kinetic = x.dot(ambient.flotation().inertia.full() * x) / 2;
  const double before = energyAt(0);
  const double most =
      before + kinetic + floating.waves.energy() - floating.waves_with_rows.energy();
  if (!(energyAt(1) - most > kRounding * (kinetic + std::abs(before)))) return 1;
  const double reached = lastPart([&](double part) { return !(energyAt(part) > most); });
  brakeWithRows(ambient, end, reached, duration);
  return reached;
}

void brakeWithRows(AmbientBody& ambient, const Vector6& x, double part, double duration) noexcept {
  ambient.floating->brake = (part - 1) / duration * (ambient.flotation().inertia.full() * x);
}

void applyAddedMassChanges(BodyMovedByRows* moved, int count, double duration) noexcept {
  AMBIENT_ASSERT(count > 0 && count <= kFlightsTogether);
  std::optional<BeforeRows> before[kFlightsTogether];
  AmbientBody* bodies[kFlightsTogether] = {};
  for (int i = 0; i < count; ++i) {
    bodies[i] = moved[i].body;
    before[i] = beforeRows(moved[i]);
    moveFlotationTo(seenFrom(movedPlane(*bodies[i], duration), moved[i].pose),
                    *bodies[i]->floating);
  }
  completeFlotationsOf(bodies, count);
  for (int i = 0; i < count; ++i) {
    bodies[i]->floating->plane_W = movedPlane(*bodies[i], duration);
    changeFrom(*before[i], moved[i], duration);
  }
}

double hydrostaticEnergyAt(const AmbientBody& ambient, const FrameOffset& pose,
                           double duration) noexcept {
  const SurfaceModel& model = *ambient.surface();
  const SurfacePlane plane_B = seenFrom(movedPlane(ambient, duration), pose);
  return hydrostaticEnergy(wetVolumeAt(model, plane_B, waterOf(ambient)), plane_B);
}

}  // namespace ambient
