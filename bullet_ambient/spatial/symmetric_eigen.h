#pragma once

#include <Eigen/Core>

#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// Eigenvalues in ascending order, and unit eigenvectors in columns.
template <int N>
struct SymmetricEigen {
  Eigen::Matrix<double, N, 1> values;
  Eigen::Matrix<double, N, N> vectors;
};

/// Diagonalises a symmetric matrix of 3 or 6 rows; reads its lower half. Compiled once for all
/// targets, because Eigen's decomposition takes seconds. Headers for users must not include this
/// one: the alignment of these matrices depends on the instruction set.
template <int N>
SymmetricEigen<N> symmetricEigen(const Eigen::Matrix<double, N, N>& matrix);

extern template SymmetricEigen<3> symmetricEigen(const Eigen::Matrix<double, 3, 3>&);
extern template SymmetricEigen<6> symmetricEigen(const Eigen::Matrix<double, 6, 6>&);

/// Principal axes of a rotational inertia.
struct PrincipalFrame {
  Vector3 moments = Vector3::Zero();       ///< principal moments [kg m^2]
  Matrix3 rotation = Matrix3::Identity();  ///< columns: principal axes in given axes; det = 1
};

/// Diagonalises a symmetric 3x3 inertia [kg m^2]; keeps the axes if it is diagonal to rounding.
PrincipalFrame findPrincipalFrame(const Matrix3& inertia);

}  // namespace ambient
