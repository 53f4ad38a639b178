#include "tests/reference/dense_rows.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>
#include <stdexcept>

namespace ambient::reference {
namespace {

using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
using Vector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;
using Vector3r = Eigen::Matrix<Real, 3, 1>;
using Matrix3r = Eigen::Matrix<Real, 3, 3>;

// Solves A x = b; the only decomposition of this source, as each takes seconds to compile.
Vector solutionOf(const Matrix& A, const Vector& b) { return A.fullPivLu().solve(b); }

enum class Bound { kFree, kLower, kUpper };

class DenseSystem {
 public:
  DenseSystem(const std::vector<DenseBody>& bodies, const std::vector<DenseRow>& rows)
      : bodies_(bodies), rows_(rows), bounds_(rows.size(), Bound::kFree) {
    for (const DenseBody& body : bodies) {
      first_unknown_.push_back(body.fixed ? -1 : unknowns_);
      if (!body.fixed) unknowns_ += 6;
    }
  }

  // Starts with one-sided rows at their zero bound. Two of them may be linearly dependent, as at
  // the two ends of a range, and must not be solved at once.
  DenseSolution solve() {
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      if (rows_[r].lower == 0 && rows_[r].upper > 0) bounds_[r] = Bound::kLower;
      if (rows_[r].upper == 0 && rows_[r].lower < 0) bounds_[r] = Bound::kUpper;
    }
    for (int visit = 0; visit < 2000; ++visit) {
      const Vector solution = solveForBounds();
      const int violated = firstViolation(solution);
      if (violated < 0) return split(solution);
      bounds_[violated] = correctedBound(violated, solution);
    }
    throw std::runtime_error("dense rows: no set of bounds fits");
  }

  std::optional<DenseSolution> onlySolution() {
    std::optional<DenseSolution> found;
    do {
      const Vector solution = solveForBounds();
      if (firstViolation(solution) >= 0) continue;
      if (found) return std::nullopt;
      found = split(solution);
    } while (advanceBounds());
    return found;
  }

 private:
  static Bound next(Bound bound) {
    return bound == Bound::kFree    ? Bound::kLower
           : bound == Bound::kLower ? Bound::kUpper
                                    : Bound::kFree;
  }

  // Tells if a row has this bound; the bounds of a friction row follow from its normal row.
  bool exists(int r, Bound bound) const {
    const DenseRow& row = rows_[r];
    if (bound == Bound::kFree || row.normal_row >= 0) return true;
    return bound == Bound::kLower ? row.lower != -DenseRow::kUnbounded
                                  : row.upper != DenseRow::kUnbounded;
  }

  // Steps bounds_ to the next combination of bounds; returns false after the last.
  bool advanceBounds() {
    for (int r = 0; r < static_cast<int>(rows_.size()); ++r) {
      do bounds_[r] = next(bounds_[r]);
      while (!exists(r, bounds_[r]));
      if (bounds_[r] != Bound::kFree) return true;
    }
    return false;
  }

  int impulseOf(int row) const { return unknowns_ + row; }

  // Unknowns: velocities of the dynamic bodies, then impulses.
  Vector solveForBounds() const {
    const int size = unknowns_ + static_cast<int>(rows_.size());
    Matrix A = Matrix::Zero(size, size);
    Vector b = Vector::Zero(size);
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      if (bodies_[i].fixed) continue;
      const int at = first_unknown_[i];
      A.block<6, 6>(at, at) = bodies_[i].inertia;
      b.segment<6>(at) = bodies_[i].inertia * bodies_[i].free_velocity;
    }
    for (int r = 0; r < static_cast<int>(rows_.size()); ++r) addRow(r, A, b);
    return solutionOf(A, b);
  }

  void addRow(int r, Matrix& A, Vector& b) const {
    const DenseRow& row = rows_[r];
    const int at = impulseOf(r);
    const auto addSide = [&](int body, const DenseVector6& jacobian) {
      if (bodies_[body].fixed) return;
      A.block<6, 1>(first_unknown_[body], at) -= jacobian;
      if (bounds_[r] == Bound::kFree)
        A.block<1, 6>(at, first_unknown_[body]) += jacobian.transpose();
    };
    for (const DenseSide& side : row.sides()) addSide(side.body, side.jacobian);
    if (bounds_[r] == Bound::kFree) {
      A(at, at) = row.softness;
      b[at] = row.target;
    } else {
      A(at, at) = 1;
      const Real sign = bounds_[r] == Bound::kLower ? -1 : 1;
      if (row.normal_row >= 0) {
        A(at, impulseOf(row.normal_row)) = -sign * row.friction;
      } else {
        const Real bound = bounds_[r] == Bound::kLower ? row.lower : row.upper;
        b[at] = std::isfinite(bound) ? bound : 0;
      }
    }
  }

  Real excess(int r, const Vector& solution) const {
    const DenseRow& row = rows_[r];
    Real value = row.softness * solution[impulseOf(r)] - row.target;
    for (const DenseSide& side : row.sides())
      if (!bodies_[side.body].fixed)
        value += side.jacobian.dot(solution.segment<6>(first_unknown_[side.body]));
    return value;
  }

  Bound correctedBound(int r, const Vector& solution) const {
    const DenseRow& row = rows_[r];
    if (!exists(r, bounds_[r])) return Bound::kFree;
    if (bounds_[r] == Bound::kLower) {
      return excess(r, solution) < 0 ? Bound::kFree : Bound::kLower;
    }
    if (bounds_[r] == Bound::kUpper) {
      return excess(r, solution) > 0 ? Bound::kFree : Bound::kUpper;
    }
    const Real impulse = solution[impulseOf(r)];
    Real lower = row.lower, upper = row.upper;
    if (row.normal_row >= 0) {
      upper = row.friction * solution[impulseOf(row.normal_row)];
      lower = -upper;
    }
    if (impulse < lower) return Bound::kLower;
    return impulse > upper ? Bound::kUpper : Bound::kFree;
  }

  int firstViolation(const Vector& solution) const {
    for (int r = 0; r < static_cast<int>(rows_.size()); ++r)
      if (correctedBound(r, solution) != bounds_[r]) return r;
    return -1;
  }

  DenseSolution split(const Vector& solution) const {
    DenseSolution result;
    result.impulses = solution.tail(static_cast<Eigen::Index>(rows_.size()));
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      result.velocities.push_back(bodies_[i].fixed
                                      ? DenseVector6(DenseVector6::Zero())
                                      : DenseVector6(solution.segment<6>(first_unknown_[i])));
    }
    return result;
  }

  const std::vector<DenseBody>& bodies_;
  const std::vector<DenseRow>& rows_;
  std::vector<Bound> bounds_;
  std::vector<int> first_unknown_;
  int unknowns_ = 0;
};

}  // namespace

std::vector<DenseSide> DenseRow::sides() const {
  std::vector<DenseSide> all{{body_a, jacobian_a}, {body_b, jacobian_b}};
  all.insert(all.end(), further.begin(), further.end());
  return all;
}

DenseSolution solveDense(const std::vector<DenseBody>& bodies, const std::vector<DenseRow>& rows) {
  return DenseSystem(bodies, rows).solve();
}

std::optional<DenseSolution> onlySolution(const std::vector<DenseBody>& bodies,
                                          const std::vector<DenseRow>& rows) {
  return DenseSystem(bodies, rows).onlySolution();
}

Real response(const std::vector<DenseBody>& bodies, const DenseRow& row, const DenseRow& to) {
  const auto jacobian = [](const DenseRow& r, int body) {
    DenseVector6 sum = DenseVector6::Zero();
    for (const DenseSide& side : r.sides())
      if (side.body == body) sum += side.jacobian;
    return sum;
  };
  Real sum = 0;
  for (int i = 0; i < static_cast<int>(bodies.size()); ++i) {
    if (bodies[i].fixed) continue;
    sum += jacobian(row, i).dot(solved(bodies[i].inertia, jacobian(to, i)));
  }
  return sum;
}

Real independence(const std::vector<DenseBody>& bodies, const std::vector<DenseRow>& rows) {
  const auto count = static_cast<Eigen::Index>(rows.size());
  Matrix A(count, count);
  for (Eigen::Index i = 0; i < count; ++i)
    for (Eigen::Index j = 0; j < count; ++j) A(i, j) = response(bodies, rows[i], rows[j]);
  const Vector scale = A.diagonal().cwiseSqrt().cwiseInverse();
  const Matrix scaled = scale.asDiagonal() * A * scale.asDiagonal();
  return Eigen::SelfAdjointEigenSolver<Matrix>(scaled, Eigen::EigenvaluesOnly).eigenvalues()[0];
}

DenseVector6 solved(const DenseMatrix6& K, const DenseVector6& m) { return solutionOf(K, m); }

DenseMatrix6 turned(const DenseMatrix6& K, const Matrix3r& rotation) {
  DenseMatrix6 B = DenseMatrix6::Zero();
  B.topLeftCorner<3, 3>() = rotation;
  B.bottomRightCorner<3, 3>() = rotation;
  return B * K * B.transpose();
}

DenseVector6 turningRate(const DenseMatrix6& K, const DenseVector6& velocity) {
  const DenseVector6 momentum = K * velocity;
  const Vector3r w = velocity.head<3>(), v = velocity.tail<3>();
  const Vector3r l = momentum.head<3>(), p = momentum.tail<3>();
  DenseVector6 rate;
  rate << l.cross(w) + p.cross(v), p.cross(w);
  rate = solved(K, rate);
  rate.tail<3>() += w.cross(v);
  return rate;
}

DenseRow pointRow(const Vector3r& direction, const Vector3r& from_a, const Vector3r& from_b) {
  DenseRow row;
  row.body_b = 1;
  row.jacobian_a << from_a.cross(direction), direction;
  row.jacobian_b << -from_b.cross(direction), -direction;
  return row;
}

DenseRow spinRow(const Vector3r& direction) {
  DenseRow row;
  row.body_b = 1;
  row.jacobian_a.head<3>() = direction;
  row.jacobian_b.head<3>() = -direction;
  return row;
}

DenseRow gearRow(const DenseRow& a, Real ratio, const DenseRow& b) {
  DenseRow row = a;
  for (const DenseSide& side : b.sides()) row.further.push_back({side.body, ratio * side.jacobian});
  return row;
}

}  // namespace ambient::reference
