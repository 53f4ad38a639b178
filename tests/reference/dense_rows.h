#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <limits>
#include <optional>
#include <vector>

namespace ambient::reference {

// Extended precision makes the rounding of the reference smaller than that of the tested code.
using Real = long double;
using DenseVector6 = Eigen::Matrix<Real, 6, 1>;  ///< rotation first
using DenseMatrix6 = Eigen::Matrix<Real, 6, 6>;

/// A rigid body with any symmetric positive definite 6x6 inertia, about its centre of mass, in
/// world axes.
struct DenseBody {
  bool fixed = false;
  DenseMatrix6 inertia = DenseMatrix6::Identity();
  DenseVector6 free_velocity = DenseVector6::Zero();  ///< at the end of the step, without rows
};

/// One body's part of a row: index and jacobian.
struct DenseSide {
  int body = 0;
  DenseVector6 jacobian = DenseVector6::Zero();
};

/// One scalar constraint J u + softness * impulse = target between two or more bodies. At a bound
/// of the impulse an inequality remains.
struct DenseRow {
  static constexpr Real kUnbounded = std::numeric_limits<Real>::infinity();

  int body_a = 0, body_b = 0;
  DenseVector6 jacobian_a = DenseVector6::Zero(), jacobian_b = DenseVector6::Zero();
  Real target = 0;
  Real softness = 0;  ///< [1/kg] for linear rows
  Real lower = -kUnbounded, upper = kUnbounded;
  int normal_row = -1;  ///< friction row: bounds are -+ friction times the impulse of that row
  Real friction = 0;
  std::vector<DenseSide> further;  ///< gear: bodies of the second joint

  /// Returns the parts of all bodies; a body may occur in several.
  std::vector<DenseSide> sides() const;
};

struct DenseSolution {
  Eigen::Matrix<Real, Eigen::Dynamic, 1> impulses;
  std::vector<DenseVector6> velocities;
};

/// Solves for velocities and impulses of all bodies and rows at once: [K, -J^T; J, softness].
/// Murty's principal pivoting changes the set of bounds until all rows are satisfied. No effective
/// masses, no iteration over rows.
/// @throws std::runtime_error if no set of bounds fits.
DenseSolution solveDense(const std::vector<DenseBody>& bodies, const std::vector<DenseRow>& rows);

/// Returns the solution if exactly one set of bounds fits, after a search of all sets. With
/// friction there may be none or several (Painleve).
std::optional<DenseSolution> onlySolution(const std::vector<DenseBody>& bodies,
                                          const std::vector<DenseRow>& rows);

/// J K^-1 J^T of two rows: change of velocity along `row` by a unit impulse of `to`.
Real response(const std::vector<DenseBody>& bodies, const DenseRow& row, const DenseRow& to);

/// Smallest eigenvalue of J K^-1 J^T of all rows, scaled to 1 on the diagonal. 1 for uncoupled
/// rows, 0 for linearly dependent ones.
Real independence(const std::vector<DenseBody>& bodies, const std::vector<DenseRow>& rows);

/// Velocity x of the momentum m = K x.
DenseVector6 solved(const DenseMatrix6& K, const DenseVector6& m);

/// Rate of change of the velocity of a body with the inertia K, both in world axes, by Kirchhoff's
/// equations without a wrench.
DenseVector6 turningRate(const DenseMatrix6& K, const DenseVector6& velocity);

/// K turned into world axes.
DenseMatrix6 turned(const DenseMatrix6& K, const Eigen::Matrix<Real, 3, 3>& rotation);

/// Row of a unit direction at a point: the velocity of body a's point minus that of body b's.
/// `from_a`, `from_b`: from the centres of mass to the point.
DenseRow pointRow(const Eigen::Matrix<Real, 3, 1>& direction,
                  const Eigen::Matrix<Real, 3, 1>& from_a, const Eigen::Matrix<Real, 3, 1>& from_b);

/// Row of the relative spin about a unit direction.
DenseRow spinRow(const Eigen::Matrix<Real, 3, 1>& direction);

/// Row of the sum a + ratio * b of two velocities; takes target and bounds of a.
DenseRow gearRow(const DenseRow& a, Real ratio, const DenseRow& b);

}  // namespace ambient::reference
