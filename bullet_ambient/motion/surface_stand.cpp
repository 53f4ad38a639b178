#include "bullet_ambient/motion/surface_stand.h"

#include <algorithm>
#include <cmath>

#include "bullet_ambient/force/surface_loads.h"
#include "bullet_ambient/motion/passive_kick.h"
#include "bullet_ambient/motion/surface_passage.h"

namespace ambient {
namespace {

double swingOf(const RestoringModes& modes, const Matrix6& inertia) {
  double square = 0;
  for (const RestoringMode& mode : modes) {
    const double along = mode.motion.dot(inertia * mode.motion);
    if (along > 0) square = std::max(square, mode.stiffness / along);
  }
  return std::sqrt(square);
}

WaveModes wavesAt(const SurfaceModel& model, const SurfaceStand& stand) {
  if (!(model.excess_density > 0)) return {};
  const Vector3& s = stand.plane.normal;
  const Matrix3 fluid =
      (stand.inertia - model.above.inertia).bottomRightCorner<3, 3>() / model.excess_density;
  return waveModesOf(
      {stand.wet, stand.plane, model.heave_factor * s.dot(fluid * s), model.wave_damping},
      stand.restoring);
}

}  // namespace

SurfaceStand standAtSurface(const SurfaceModel& model, const SurfacePlane& plane_B) noexcept {
  SurfaceStand stand;
  stand.plane = plane_B;
  stand.immersion_F = immersionOf(model, plane_B);
  stand.wet = stand.immersion_F.wet.inB(model.fluid_frame);
  const TotalInertia total = inertiaAt(model, stand.immersion_F);
  stand.inertia = total.inertia;
  stand.inverse = total.inverse;
  stand.restoring = restoringModesOf(stand.wet, plane_B);
  stand.waves = wavesAt(model, stand);
  stand.swing = swingOf(stand.restoring, stand.inertia);
  return stand;
}

bool isStable(const RestoringModes& modes) noexcept {
  return modes[0].stiffness > 0 && modes[1].stiffness > 0 && modes[2].stiffness > 0;
}

Matrix6 stiffInertia(const SurfaceStand& stand, double duration) noexcept {
  Matrix6 K = stand.inertia;
  for (const RestoringMode& mode : stand.restoring)
    K += duration * duration / 4 * std::max(0.0, mode.stiffness) * mode.motion *
         mode.motion.transpose();
  return K;
}

BodyModel frozenAt(const SurfaceModel& model, const SurfaceStand& stand) noexcept {
  BodyModel frozen = model.above;
  frozen.inertia = stand.inertia;
  frozen.inverse_inertia = stand.inverse;
  frozen.has_diagonal_inertia = false;
  const double water = model.excess_density * stand.wet.volume;
  frozen.displaced_mass = model.above.displaced_mass + water;
  if (frozen.displaced_mass > 0) {
    frozen.centre_of_volume = (model.above.displaced_mass * model.above.centre_of_volume +
                               model.excess_density * stand.wet.moment) /
                              frozen.displaced_mass;
  }
  frozen.loads = nullptr;
  return frozen;
}

Wrench gradientAt(const SurfaceModel& model, const SurfaceStand& stand, const Vector6& x) noexcept {
  const FrameOffset& frame = model.fluid_frame;
  const Immersion& at = stand.immersion_F;
  const Twist in_F = frame.toF(Twist::fromVector(x));
  return model.excess_density * frame.toB(model.wetted->gradient(at, in_F).wrench(at.plane));
}

BoundedTwist passSurface(const SurfaceMove& move, const Vector6& x) noexcept {
  const SurfaceStand& after = move.after;
  const Immersion& at = after.immersion_F;
  const Vector3 centre = after.wet.volume > 0 ? Vector3(after.wet.moment / after.wet.volume)
                                              : move.model.above.centre_of_volume;
  return passSurface(
      {move.inertia_before, after.inertia, after.inverse, move.gradient, after.plane.normal, centre,
       at.draught(), at.cover(), after.plane.gravity, move.duration},
      x);
}

Vector6 takeWind(const WindKick& kick, const Vector6& x) noexcept {
  const PartLoads& part = kick.model.loads_above;
  const SurfaceStand& stand = kick.stand;
  const Vector6 shift = stack(Vector3::Zero(), kick.wind);
  const Vector6 seen = x + shift;
  const double share = 1 - wetShare(stand.immersion_F, kick.model.shape->volume);
  const WetPart in_air{seenFrom(stand.plane, part.frame).flipped(), share};
  const Twist twist = Twist::fromVector(seen);
  const Vector6 load = part.frame.toB(part.loads->wetLoad(part.frame.toF(twist), in_air)).vector();
  const DualPair motion{seen, stand.inertia * seen};
  return passiveKick(motion, {motion, {stand.inverse * load, load}}, kick.duration).twist - shift;
}

}  // namespace ambient
