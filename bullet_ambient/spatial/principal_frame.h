#pragma once

#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// Principal axes of a rotational inertia.
struct PrincipalFrame {
  Vector3 moments = Vector3::Zero();       ///< [kg m^2]
  Matrix3 rotation = Matrix3::Identity();  ///< principal axes to given axes, det = 1
};

/// Diagonalises an inertia; one that is diagonal to rounding keeps its axes.
PrincipalFrame findPrincipalFrame(const Matrix3& inertia);

}  // namespace ambient
