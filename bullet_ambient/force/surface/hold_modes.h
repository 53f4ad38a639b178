#pragma once

#include "bullet_ambient/force/surface/hold_shape.h"
#include "bullet_ambient/spatial/spatial_vectors.h"

namespace ambient {

/// First mode of sloshing of the water in a hold along one axis of its level: a pendulum, in F;
/// docs/theory.md eq. (149).
struct SloshMode {
  Vector3 axis{0, 0, 0};   ///< e: unit, along the level
  Vector3 bob{0, 0, 0};    ///< place of the mass that moves [m]
  Vector3 pivot{0, 0, 0};  ///< where it hangs: at rest there, the hold tilts around a still bob [m]
  double volume = 0;       ///< that mass, per unit density [m^3]; 0: there is no mode
  double square = 0;       ///< omega^2 [1/s^2]
  double farthest = 0;     ///< way at which the surface meets the floor or the top of the hold [m]
};

/// Motion of the water in a hold: its two modes, and its resistance to turning.
struct HoldModes {
  SloshMode modes[2];
  Matrix3 turning = Matrix3::Zero();  ///< J about its centre, per unit density, eq. (151) [m^5]
};

/// Finds the modes along the principal axes of the level. Exact for boxes; of cylinders and half
/// balls omega is at most 1.5 % off, of round canals and V's 7 %. Full or empty holds have none.
/// `fill` is that of the hold by fillHold() along the normal of the plane, whose gravity is that
/// which the water feels.
HoldModes modesOf(const HoldShape& shape, const HoldFill& fill,
                  const SurfacePlane& plane_F) noexcept;

/// Inertia of the water in a hold as it moves with the body, less that of its modes, per unit
/// density, about F's origin; docs/theory.md eq. (150). Positive semidefinite.
Matrix6 carriedInertia(const WetVolume& water, const HoldModes& modes) noexcept;

}  // namespace ambient
