#pragma once

#include <cmath>

#include "bullet_ambient/spatial/frame_offset.h"
#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

// Conditions of asserts. Numbers that are not finite pass: a state may have them until its step is
// refused at the end.

/// True if a square matrix is symmetric, up to `rounding` times its largest entry.
template <class Matrix>
bool isSymmetric(const Eigen::MatrixBase<Matrix>& m, double rounding = 0) {
  return !((m - m.transpose()).cwiseAbs().maxCoeff() > rounding * m.cwiseAbs().maxCoeff());
}

/// True if a vector has length 1.
inline bool isUnit(const Vector3& v) { return !(std::abs(v.squaredNorm() - 1) > 1e-5); }

/// True if a matrix is a rotation: it neither scales nor mirrors.
inline bool isRotation(const Matrix3& R) {
  return isUnit(R.col(0)) && isUnit(R.col(1)) && isUnit(R.col(2)) &&
         !((R.col(0).cross(R.col(1)) - R.col(2)).cwiseAbs().maxCoeff() > 1e-5);
}

}  // namespace ambient
