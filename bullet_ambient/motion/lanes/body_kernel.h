#pragma once

#include "bullet_ambient/motion/lanes/spatial_lanes.h"

// Steps of one body or of one body per lane, see spatial_lanes.h.

namespace ambient {

namespace {

/// Drag and lift of a load F at the twist y of its sample, eq. (23).
template <class Real>
struct DragAndLift {
  const PairsOf<Real>& at;
  MaskOf<Real> moves;    ///< at rest relative to the fluid there is no load
  Real inverse_n;        ///< 1/|y|
  Real decay;            ///< d
  PairsOf<Real> across;  ///< a
  Real f, inverse_f;     ///< |a|

  DragAndLift(const PairsOf<Real>& sample, const PairsOf<Real>& load) : at(sample) {
    const Real one = all<Real>(1), zero = Real{};
    constexpr double kLeast = 1e-290;  // [2 J] the inverse of less may not be finite
    const Real energy = inner(at, at);
    moves = energy > all<Real>(kLeast);
    const Real inverse_energy = one / (moves ? energy : one);
    inverse_n = one / squareRoot(moves ? energy : one);
    const Real along = inner(at, load) * inverse_energy;
    decay = along > zero ? zero : -along;  // NaN of a load that is not finite stays NaN, because
                                           // NaN > 0 is false
    // Lift: K^-1 F minus its part along the twist.
    across = load - along * at;
    f = squareRoot(larger(inner(across, across), zero));
    inverse_f = one / (f > zero ? f : one);
  }
  /// |x|/n.
  Real speedOf(const PairsOf<Real>& x) const {
    return squareRoot(larger(inner(x, x), Real{})) * inverse_n;
  }
  /// Rot(angle) x. Sine and versine from one tangent: a rotation for any rounding of the tangent.
  PairsOf<Real> turned(const PairsOf<Real>& x, const Real& angle) const {
    const Real c1 = inner(x, at) * inverse_n;
    const Real c2 = inner(x, across) * inverse_f;
    const Real t = tangent<Real>(0.5 * angle);
    const Real sine = 2 * t / (1 + t * t);
    const Real versine = t * sine;
    return x + ((-versine * c1 - sine * c2) * inverse_n) * at +
           ((sine * c1 - versine * c2) * inverse_f) * across;
  }
};

/// Returns the motion `x` after `duration` [s] under a load homogeneous of degree 2 in the twist,
/// docs/theory.md eq. (23):
///
///   x' = Rot(theta) x / (1 + z),  z = d h |x| / n,  theta = h (|a| / n) (|x| / n) ln(1 + z) / z
///
///   x, x'  twist before and after `duration` h, >= 0
///   K      total inertia; |x| = sqrt(x.K x) is the norm of a twist in it [sqrt(J)]
///   y, F   twist and load of the sample, `at` and `load`: pairs y, K y and K^-1 F, F; n = |y|
///   d      drag, max(-F.y / n^2, 0) [1/s]: 0 if F feeds energy at the sample
///   a      lift: K^-1 F = -d y + a with y.K a = 0
///   Rot    rotation by theta in the plane of y and a, orthogonal in the norm of K
///
/// Drag is an exact quadratic decay and lift an exact rotation: |x'| <= |x| for any duration.
template <class Real>
inline PairsOf<Real> passiveKick(const PairsOf<Real>& x, const PairsOf<Real>& at,
                                 const PairsOf<Real>& load, const Real& duration) {
  const DragAndLift<Real> split(at, load);
  const Real speed = split.speedOf(x);
  const Real z = split.decay * duration * speed;
  const Real angle = duration * split.f * split.inverse_n * logarithmRatio(z) * speed;
  return select(split.moves, all<Real>(1) / (1 + z) * split.turned(x, angle), x);
}

/// Returns the error e of a kick, eq. (25). `load_error`: load that was not predicted.
/// `velocity_scale` avoids tiny substeps where the speed of a swing passes through 0.
inline Lanes relativeError(const Pairs& x, const Pairs& load_error, const Lanes& duration,
                           const Lanes& velocity_scale) {
  const Lanes zero = Lanes{};
  const Lanes change = duration * squareRoot(larger(inner(load_error, load_error), zero));
  const Lanes scale = squareRoot(larger(inner(x, x), zero)) + velocity_scale;
  return scale > zero ? change / (scale > zero ? scale : all(1)) : zero;
}

/// Returns the turn number m of a turn, docs/theory.md eq. (28a): the larger of |w| / spin and
/// (|t| / |x|) / largest_change. `change`: pair of t; `motion`: pair of x.
template <class Real>
inline Real turnNumberOf(const PairsOf<Real>& change, const PairsOf<Real>& motion, const Real& spin,
                         const Real& largest_change) {
  const Real zero = Real{};
  const Real energy = inner(motion, motion);
  const MaskOf<Real> moves = energy > zero;
  const Real part_sq = larger(inner(change, change), zero) / (moves ? energy : all<Real>(1));
  const Real part = moves ? squareRoot(part_sq) : zero;
  const VectorsOf<Real>& w = motion.twist.angular;
  return larger<Real>(part / largest_change, squareRoot(dot(w, w)) / spin);
}

/// Returns the gyroscopic wrench of a motion in B, eq. (2).
template <class Real>
inline SpatialsOf<Real> gyroscopic(const PairsOf<Real>& x) {
  const VectorsOf<Real>&w = x.twist.angular, &p = x.momentum.linear;
  return {cross(x.momentum.angular, w) + cross(p, x.twist.linear), cross(p, w)};
}

/// Turning part t of eq. (28) over a step, in B, and its turn_number.
template <class Real>
struct TurningsOf {
  SpatialsOf<Real> change;
  Real turn_number;

  /// The part of t that is X.
  Real share() const {
    const Real zero = Real{}, rest = all<Real>(1) - turn_number, half = all<Real>(0.5);
    return rest < zero ? zero : (rest > half ? half : rest);
  }
};

/// Computes the turnings of free bodies explicitly. `motion`: relative to the flow; duration [s].
template <class Real, class Matrices>
TurningsOf<Real> computeTurnings(const Matrices& inertia, const Matrices& inverse,
                                 const PairsOf<Real>& motion, const Real& duration) {
  const SpatialsOf<Real>& x = motion.twist;
  SpatialsOf<Real> change = duration * (inverse * gyroscopic(motion));
  change.linear = change.linear + duration * cross(x.angular, x.linear);
  const Real turn_number = turnNumberOf<Real>({change, inertia * change}, motion,
                                              all<Real>(0.5) / duration, all<Real>(0.45));
  return {change, turn_number};
}

// Resistance of a viscous fluid in a step, docs/theory.md eq. (120) to (122).

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
