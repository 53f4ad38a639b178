#pragma once

#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// Computes the semi-axes [m] of the ellipsoid with given added masses against translation along
/// its axes, per unit density [m^3]. Any three positive added masses belong to exactly one
/// ellipsoid. One below 1e-5 of the largest, as of a sheet, is raised to that.
Vector3 semiAxesOf(const Vector3& added_mass);

/// Ellipsoid whose added mass approximates a given one.
struct EllipsoidFit {
  Vector3 semi_axes{0, 0, 0};          ///< [m]
  Vector3 centre{0, 0, 0};             ///< [m]
  Matrix3 axes = Matrix3::Identity();  ///< axes of the ellipsoid, as columns
};

/// Fits an ellipsoid to an added mass per unit density. Axes and sizes follow from the translation
/// block. The centre is where rotation and translation couple least (sum of squares); where that
/// leaves a choice, as for sheets, nearest to `middle` [m].
EllipsoidFit fitEllipsoid(const Matrix6& added_mass, const Vector3& middle);

}  // namespace ambient
