#pragma once

#include "bullet_ambient/motion/body/bounded_twist.h"
#include "bullet_ambient/motion/surface/body_waves.h"
#include "bullet_ambient/motion/surface/surface_model.h"

namespace ambient {

/// A body at one pose against the surface of the water; in B but for what is named otherwise.
struct SurfacePlace {
  SurfacePlane plane;
  Immersion immersion_F;
  WetVolume wet;
  Matrix6 inertia;  ///< K of body and fluids, docs/theory.md eq. (63)
};

/// `plane_B` with the density and gravity that count.
SurfacePlace placeAt(const SurfaceModel& model, const SurfacePlane& plane_B) noexcept;

/// A place and what follows from it.
struct SurfaceStand : SurfacePlace {
  Matrix6 inverse;  ///< K^-1
  RestoringModes restoring;
  WaveModes waves;   ///< that it makes
  double swing = 0;  ///< the largest natural frequency [1/s]
};

/// Whether small displacements are turned back: up and down, and about both axes of the waterplane.
bool isStable(const RestoringModes& modes) noexcept;

/// Times the largest natural frequency, the longest step that needs no stiffInertia().
constexpr double kLongestSwing = 0.5;

/// K with which a longer step of `duration` [s] does not overshoot the balance of the buoyancy: by
/// the implicit trapezoidal rule, stiffened().
Matrix6 stiffInertia(const SurfaceStand& stand, double duration) noexcept;

/// The body as one of constant inertia and displacement, for a step in which rows move it. Its
/// loads, in the frame of `loads_below`, are left to the caller.
BodyModel frozenAt(const SurfaceModel& model, const SurfaceStand& stand) noexcept;

/// F_K of docs/theory.md eq. (66) for a twist in B relative to the water.
Wrench gradientAt(const SurfaceModel& model, const SurfacePlace& place, const Twist& x) noexcept;

/// Centre of the wet volume; where there is none, that of the body.
Vector3 centreOfBuoyancy(const SurfaceModel& model, const SurfacePlace& place) noexcept;

/// Passage of a body through the surface between two poses: x_1 of docs/theory.md eq. (66) to (68),
/// from the twist that it would have at the second with the inertia of the first, K_0.
struct SurfaceMove {
  const SurfaceModel& model;
  const Matrix6& inertia_before;
  const SurfaceStand& after;
  double duration;
  Wrench gradient;  ///< F_K at the first pose or the second
};
BoundedTwist passSurface(const SurfaceMove& move, const Vector6& x) noexcept;

/// Load on the part of a body in one of the fluids, in B, for a twist in B relative to that fluid.
Wrench loadBelow(const SurfaceModel& model, const SurfacePlace& place, const Twist& x) noexcept;
/// Part of loadBelow() that is friction.
Wrench frictionBelow(const SurfaceModel& model, const SurfacePlace& place, const Twist& x) noexcept;
Wrench loadAbove(const SurfaceModel& model, const SurfacePlace& place, const Twist& x) noexcept;

/// The fluid above blows on the dry part of a body.
struct WindKick {
  const SurfaceModel& model;  ///< @pre it has loads_above.loads
  const SurfaceStand& stand;
  Vector3 wind;     ///< velocity of the water less that of the fluid above, in B [m/s]
  double duration;  ///< [s]
};

/// The twist after it, by docs/theory.md eq. (23) in the frame of the fluid above. Twists in B,
/// relative to the water. Cost: one evaluation of the loads.
Vector6 takeWind(const WindKick& kick, const Vector6& x) noexcept;

}  // namespace ambient
