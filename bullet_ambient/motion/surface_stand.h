#pragma once

#include "bullet_ambient/motion/body_waves.h"
#include "bullet_ambient/motion/bounded_twist.h"
#include "bullet_ambient/motion/surface_model.h"

namespace ambient {

/// A body at one pose against the surface of the water; in B but for what is named otherwise.
struct SurfaceStand {
  SurfacePlane plane;
  Immersion immersion_F;
  WetVolume wet;
  Matrix6 inertia;  ///< K of body and fluids, docs/theory.md eq. (63)
  Matrix6 inverse;  ///< K^-1
  RestoringModes restoring;
  WaveModes waves;   ///< that it makes
  double swing = 0;  ///< the largest natural frequency [1/s]
};

/// `plane_B` with the density and gravity that count. Cost: 1 us for a hull of some hundred
/// triangles.
SurfaceStand standAtSurface(const SurfaceModel& model, const SurfacePlane& plane_B) noexcept;

/// Whether small displacements are turned back: up and down, and about both axes of the waterplane.
bool isStable(const RestoringModes& modes) noexcept;

/// Times the largest natural frequency, the longest step that needs no stiffInertia().
constexpr double kLongestSwing = 0.5;

/// K with which a longer step of `duration` [s] does not overshoot the balance of the buoyancy: by
/// the implicit trapezoidal rule, K + duration^2/4 N k N^T over the stiffnesses k > 0.
Matrix6 stiffInertia(const SurfaceStand& stand, double duration) noexcept;

/// The body as one of constant inertia and displacement, for a step in which rows move it. Its
/// loads, in the frame of `loads_below`, are left to the caller.
BodyModel frozenAt(const SurfaceModel& model, const SurfaceStand& stand) noexcept;

/// F_K of docs/theory.md eq. (66) for a twist in B relative to the water.
Wrench gradientAt(const SurfaceModel& model, const SurfaceStand& stand, const Vector6& x) noexcept;

/// Where a body passes the surface between two poses: x_1 of docs/theory.md eq. (66) to (68), from
/// the twist that it would have at the second with the inertia of the first, K_0.
struct SurfaceMove {
  const SurfaceModel& model;
  const Matrix6& inertia_before;
  const SurfaceStand& after;
  double duration;
  Wrench gradient;  ///< F_K at the first pose or the second
};
BoundedTwist passSurface(const SurfaceMove& move, const Vector6& x) noexcept;

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
