#pragma once

#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// Semi-axes [m] of the ellipsoid that has these added masses against translation along its axes,
/// per unit density [m^3]. Any three positive ones are those of exactly one ellipsoid. A mass below
/// 1e-5 of the largest, as of sheets, counts as that.
Vector3 semiAxesOf(const Vector3& added_mass);

/// The ellipsoid with the added mass that comes nearest to one.
struct EllipsoidFit {
  Vector3 semi_axes{0, 0, 0};          ///< [m]
  Vector3 centre{0, 0, 0};             ///< [m]
  Matrix3 axes = Matrix3::Identity();  ///< its axes, as columns
};

/// Fits to an added mass per unit density: axes and sizes are those of its translation block, the
/// centre is where rotation and translation couple least, by the sum of squares, and nearest to
/// `middle` [m] where that leaves a choice, as for sheets.
EllipsoidFit fitEllipsoid(const Matrix6& added_mass, const Vector3& middle);

}  // namespace ambient
