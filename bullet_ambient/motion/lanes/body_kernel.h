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

}  // namespace

}  // namespace ambient
