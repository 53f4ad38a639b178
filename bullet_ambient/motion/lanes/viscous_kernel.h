#pragma once

#include "bullet_ambient/motion/lanes/body_kernel.h"

// Resistance of a viscous fluid in a step, docs/theory.md eq. (120) to (122), of one body or of one
// body per lane, see spatial_lanes.h.

namespace ambient {
namespace {

/// Factors L D L^T of a symmetric 6x6 matrix K, or of one per lane.
template <class Real>
class PositiveFactor {
 public:
  explicit PositiveFactor(const SymmetricOf<Real>& K) {
    const Real one = all<Real>(1), zero = Real{};
    Real scaled[6];  // a row of L D
    for (int i = 0; i < 6; ++i) {
      Real pivot = entry(K, i, i);
      for (int j = 0; j < i; ++j) {
        scaled[j] = entry(K, i, j);
        for (int k = 0; k < j; ++k) scaled[j] = scaled[j] - scaled[k] * lower_[j][k];
        lower_[i][j] = scaled[j] * inverse_pivot_[j];
        pivot = pivot - scaled[j] * lower_[i][j];
      }
      const MaskOf<Real> is_fine = pivot > zero;
      is_positive_ = i == 0 ? is_fine : is_positive_ & is_fine;
      inverse_pivot_[i] = one / (is_fine ? pivot : one);
    }
  }

  /// Returns the lanes whose matrix is positive definite. Results in other lanes are undefined.
  MaskOf<Real> isPositive() const { return is_positive_; }

  /// Returns K^-1 b.
  SpatialsOf<Real> solve(const SpatialsOf<Real>& b) const {
    Real x[6] = {b.angular.x, b.angular.y, b.angular.z, b.linear.x, b.linear.y, b.linear.z};
    for (int i = 1; i < 6; ++i)
      for (int j = 0; j < i; ++j) x[i] = x[i] - lower_[i][j] * x[j];
    for (int i = 5; i >= 0; --i) {
      x[i] = x[i] * inverse_pivot_[i];
      for (int j = i + 1; j < 6; ++j) x[i] = x[i] - lower_[j][i] * x[j];
    }
    return {{x[0], x[1], x[2]}, {x[3], x[4], x[5]}};
  }

  /// Returns K^-1.
  SymmetricOf<Real> inverse() const {
    Real M[6][6];  // L^-1 below its diagonal of ones
    for (int j = 0; j < 6; ++j)
      for (int i = j + 1; i < 6; ++i) {
        Real sum = lower_[i][j];
        for (int k = j + 1; k < i; ++k) sum = sum + lower_[i][k] * M[k][j];
        M[i][j] = -sum;
      }
    SymmetricOf<Real> inverse;
    for (int j = 0; j < 6; ++j)
      for (int i = 0; i <= j; ++i) {
        Real sum = i == j ? inverse_pivot_[j] : M[j][i] * inverse_pivot_[j];
        for (int k = j + 1; k < 6; ++k) sum = sum + M[k][i] * M[k][j] * inverse_pivot_[k];
        entry(inverse, i, j) = sum;
      }
    return inverse;
  }

 private:
  Real lower_[6][6];  // L below its diagonal of ones
  Real inverse_pivot_[6];
  MaskOf<Real> is_positive_;
};

/// Inertia K and resistance C of bodies: what eq. (120) needs of them.
template <class Real>
class Settling {
 public:
  Settling(const SymmetricOf<Real>& inertia, const SymmetricOf<Real>& inverse,
           const SymmetricOf<Real>& resistance)
      : K_(inertia), C_(resistance) {
    for (int j = 0; j < 6; ++j) {
      const SpatialsOf<Real> column = C_ * (inverse * columnOf(C_, j));
      const Real entries[6] = {column.angular.x, column.angular.y, column.angular.z,
                               column.linear.x,  column.linear.y,  column.linear.z};
      for (int i = 0; i <= j; ++i) entry(square_, i, j) = entries[i];
    }
  }
  SpatialsOf<Real> ofInertia(const SpatialsOf<Real>& x) const { return K_ * x; }
  SpatialsOf<Real> drag(const SpatialsOf<Real>& x) const { return C_ * x; }
  /// Returns (a K + b C + c C K^-1 C)^-1 f.
  SpatialsOf<Real> solve(const Real& a, const Real& b, const Real& c,
                         const SpatialsOf<Real>& f) const {
    SymmetricOf<Real> M;
    for (int i = 0; i < kSymmetricEntries; ++i)
      M.entries[i] = a * K_.entries[i] + (b * C_.entries[i] + c * square_.entries[i]);
    return PositiveFactor<Real>(M).solve(f);
  }

 private:
  static SpatialsOf<Real> columnOf(const SymmetricOf<Real>& m, int j) {
    return {{entry(m, 0, j), entry(m, 1, j), entry(m, 2, j)},
            {entry(m, 3, j), entry(m, 4, j), entry(m, 5, j)}};
  }

  const SymmetricOf<Real>& K_;
  const SymmetricOf<Real>& C_;
  SymmetricOf<Real> square_;  // C K^-1 C
};

/// The same for bodies with three planes of symmetry, with the same bits.
class DiagonalSettling {
 public:
  DiagonalSettling(const DiagonalMatrices& inertia, const DiagonalMatrices& inverse,
                   const DiagonalMatrices& resistance)
      : K_(inertia), inverse_(inverse), C_(resistance) {}
  Spatials ofInertia(const Spatials& x) const { return K_ * x; }
  Spatials drag(const Spatials& x) const { return C_ * x; }
  Spatials solve(const Lanes& a, const Lanes& b, const Lanes& c, const Spatials& f) const {
    const auto of = [&](int i, const Lanes& y) {
      const Lanes &k = K_.at(i), &r = C_.at(i);
      return y * (1 / (a * k + (b * r + c * (r * (inverse_.at(i) * r)))));
    };
    return {{of(0, f.angular.x), of(1, f.angular.y), of(2, f.angular.z)},
            {of(3, f.linear.x), of(4, f.linear.y), of(5, f.linear.z)}};
  }

 private:
  const DiagonalMatrices &K_, &inverse_, &C_;
};

template <class Real>
inline Settling<Real> settlingOf(const SymmetricOf<Real>& inertia, const SymmetricOf<Real>& inverse,
                                 const SymmetricOf<Real>& resistance) {
  return {inertia, inverse, resistance};
}
inline DiagonalSettling settlingOf(const DiagonalMatrices& inertia, const DiagonalMatrices& inverse,
                                   const DiagonalMatrices& resistance) {
  return {inertia, inverse, resistance};
}

/// A wrench and its response that are zero.
template <class Real>
inline PairsOf<Real> noWrench() {
  const VectorsOf<Real> zero{Real{}, Real{}, Real{}};
  return {{zero, zero}, {zero, zero}};
}

/// V of eq. (120) for the momentum K x of a motion x, after `duration` t [s] under the resistance C
/// and a drag q K x, implicitly: never turns the motion round, and only takes energy, for any t.
/// q [1/s], >= 0.
template <class Real, class Terms>
inline PairsOf<Real> settle(const SpatialsOf<Real>& momentum, const Terms& terms, const Real& q,
                            const Real& duration) {
  const Real tq = duration * q;
  const SpatialsOf<Real> twist = terms.solve(1 + tq + 0.5 * tq * tq, duration + duration * tq,
                                             0.5 * duration * duration, momentum);
  return {twist, terms.ofInertia(twist)};
}

/// The same under a wrench f, too: exact in the steady state. `fall`: pair t K^-1 f, t f.
template <class Real, class Terms>
inline PairsOf<Real> settle(const PairsOf<Real>& x, const PairsOf<Real>& fall, const Terms& terms,
                            const Real& q, const Real& duration) {
  const Real half = 0.5 * duration;
  return settle(x.momentum + ((1 + half * q) * fall.momentum + half * terms.drag(fall.twist)),
                terms, q, duration);
}

/// q of eq. (121) over half a kick of `duration` [s].
template <class Real>
inline Real dragRate(const DragAndLift<Real>& split, const PairsOf<Real>& x, const Real& duration) {
  const Real half = 0.5 * split.speedOf(x);
  const Real fast = half / (1 + split.decay * half * duration);
  return split.decay * larger<Real>(fast, all<Real>(1));
}

/// Angle of Rot in eq. (122) over `duration` [s].
template <class Real>
inline Real liftAngle(const DragAndLift<Real>& split, const PairsOf<Real>& x,
                      const Real& duration) {
  const Real zero = Real{};
  const Real angle = duration * split.f * split.inverse_n * split.speedOf(x);
  return split.moves ? angle : zero;
}

/// Returns the motion after a kick of `duration` h [s], eq. (122): V, Rot, V. `fall`: change by the
/// wrench f in h/2; `at`, `load`: pairs of the sampled motion and of the load there without
/// resistance.
template <class Real, class Terms>
inline PairsOf<Real> viscousKick(const PairsOf<Real>& x, const PairsOf<Real>& at,
                                 const PairsOf<Real>& load, const PairsOf<Real>& fall,
                                 const Terms& terms, const Real& duration) {
  const DragAndLift<Real> split(at, load);
  const Real half = 0.5 * duration;
  const PairsOf<Real> first = settle(x, fall, terms, dragRate(split, x, half), half);
  const PairsOf<Real> turned = split.turned(first, liftAngle(split, first, duration));
  return settle(turned, fall, terms, dragRate(split, turned, half), half);
}

/// Returns the motion after `duration` h [s] of a body that the fluid settles meanwhile, eq. (124):
/// Rot, then the wrench f, resistance and drag at once. `load`: pair of the load at x without
/// resistance.
template <class Real, class Terms>
inline PairsOf<Real> settledKick(const PairsOf<Real>& x, const PairsOf<Real>& load,
                                 const SpatialsOf<Real>& wrench, const Terms& terms,
                                 const Real& duration) {
  const DragAndLift<Real> split(x, load);
  const PairsOf<Real> turned = split.turned(x, liftAngle(split, x, duration));
  const Real z = duration * split.decay;
  const SpatialsOf<Real> push =
      duration * (wrench - terms.drag(turned.twist)) - z * turned.momentum;
  const SpatialsOf<Real> change = terms.solve(1 + z, duration, Real{}, push);
  return {turned.twist + change, turned.momentum + terms.ofInertia(change)};
}

/// Returns the motion in the middle of that kick as the load at x itself predicts it.
template <class Real, class Terms>
inline PairsOf<Real> viscousSample(const PairsOf<Real>& x, const PairsOf<Real>& load,
                                   const PairsOf<Real>& fall, const Terms& terms,
                                   const Real& duration) {
  const DragAndLift<Real> split(x, load);
  const Real half = 0.5 * duration;
  const PairsOf<Real> first = settle(x, fall, terms, dragRate(split, x, half), half);
  return split.turned(first, liftAngle(split, first, half));
}

}  // namespace
}  // namespace ambient
