#pragma once

#include <Eigen/Core>

namespace ambient::test {

// Decompositions by Eigen, compiled once: each takes seconds in every source that instantiates it.

/// A^-1 of a regular square matrix.
Eigen::MatrixXd inverse(const Eigen::MatrixXd& A);

/// x of A x = b for a regular square matrix A.
Eigen::VectorXd solve(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);

/// X that makes the norm of each column of A X - B least. A has full column rank.
Eigen::MatrixXd leastSquares(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);

/// Eigenvalues of a symmetric matrix, ascending.
Eigen::VectorXd symmetricEigenvalues(const Eigen::MatrixXd& A);

/// Values s with A x = s B x, ascending. A is symmetric, B symmetric and positive definite.
Eigen::VectorXd generalizedEigenvalues(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);

}  // namespace ambient::test
