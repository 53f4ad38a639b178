#pragma once

#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// Principal axes of a rotational inertia.
struct PrincipalFrame {
  Vector3 moments = Vector3::Zero();       ///< principal moments [kg m^2]
  Matrix3 rotation = Matrix3::Identity();  ///< columns: principal axes in given axes; det = 1
};

/// Diagonalises a symmetric 3x3 inertia [kg m^2]; keeps the axes if it is diagonal to rounding.
PrincipalFrame findPrincipalFrame(const Matrix3& inertia);

}  // namespace ambient
