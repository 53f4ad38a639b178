#pragma once

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/motion/lanes/motion_lanes.h"
#include "bullet_ambient/motion/lanes/spatial_lanes.h"

// Only for sources compiled once per instruction set, see spatial_lanes.h.

namespace ambient {
namespace {

/// Power series in time of Kirchhoff's equations without forces, in body axes, docs/theory.md eq.
/// (22):
///
///   l' = l x w + p x v,   p' = p x w,   (w, v) = K^-1 (l, p),
///   r' = r x w + v,       q' = 1/2 q w
///
///   r   displacement since the start in body axes, y = y_0 + R r
///   q   rotation since the start
///
/// The equations are bilinear, so that each coefficient is a sum of cross products of earlier ones
/// (Jorba and Zou 2005). Time is the fraction of the duration. Each body gets the number of terms
/// that its precision needs; further terms are zero.
template <class Inverse>
class MotionSeries {
 public:
  /// Computes the series of the bodies in the mask `moves`.
  MotionSeries(const Inverse& inverse, const Pairs& start, const Lanes& duration,
               const Lanes& precision, const Mask& moves)
      : inverse_(inverse), duration_(duration), precision_sq_(precision * precision) {
    const Vectors zero = zeroVectors();
    c_[0] = {start, zero, {zero, all(1)}};
    const Lanes energy = inner(start, start);
    inverse_energy_ = 1 / (energy > Lanes{} ? energy : all(1));
    is_open_ = moves;
    do {
      addTerm();
      is_open_ = is_open_ & ~isRestBelowPrecision();
    } while (order_ < kMaxOrder && anyOf(is_open_));
  }

  struct End {
    Lanes fraction;  // largest fraction of the duration at which the series has its precision
    Spatials momentum;
    Vectors displacement;
    Orientations turn;  // not normalised
  };
  End end() const {
    const Lanes fraction = reach();
    const Coefficient& last = c_[order_];
    End sum{fraction, last.motion.momentum, last.displacement, last.turn};
    for (int k = order_ - 1; k >= 0; --k) {
      const Coefficient& c = c_[k];
      sum.momentum = c.motion.momentum + fraction * sum.momentum;
      sum.displacement = c.displacement + fraction * sum.displacement;
      sum.turn = {c.turn.u + fraction * sum.turn.u, c.turn.w + fraction * sum.turn.w};
    }
    return sum;
  }

 private:
  static constexpr int kLeastOrder = 3, kMaxOrder = 18;

  struct Coefficient {
    Pairs motion;
    Vectors displacement;
    Orientations turn;
  };

  // Computes the next coefficient from all earlier ones.
  void addTerm() {
    const int k = order_;
    // Products with the zeroth coefficient: displacement 0, identity rotation.
    const Spatials& latest = c_[k].motion.twist;
    const Spatials& first = c_[0].motion.momentum;
    Vectors l = cross(first.angular, latest.angular) + cross(first.linear, latest.linear);
    Vectors p = cross(first.linear, latest.angular);
    Vectors turn = latest.angular;
    Vectors displacement = latest.linear;
    Lanes cosine = Lanes{};
    for (int i = 1; i <= k; ++i) {
      const Coefficient& a = c_[i];
      const Spatials& b = c_[k - i].motion.twist;
      const Spatials& m = a.motion.momentum;
      l = l + (cross(m.angular, b.angular) + cross(m.linear, b.linear));
      p = p + cross(m.linear, b.angular);
      displacement = displacement + cross(a.displacement, b.angular);
      turn = turn + (cross(a.turn.u, b.angular) + a.turn.w * b.angular);
      cosine = cosine - dot(a.turn.u, b.angular);
    }
    // A series that has reached its precision gets zero terms.
    const Lanes step = is_open_ ? (1.0 / (k + 1)) * duration_ : Lanes{};
    Coefficient& next = c_[k + 1];
    next.motion.momentum = step * Spatials{l, p};
    next.motion.twist = inverse_ * next.motion.momentum;
    next.displacement = step * displacement;
    const Lanes half = 0.5 * step;
    next.turn = {half * turn, half * cosine};
    ++order_;
    const Lanes size_before = size_sq_;
    size_sq_ = larger(inner(next.motion, next.motion) * inverse_energy_,
                      dot(next.turn.u, next.turn.u) + next.turn.w * next.turn.w);
    const Lanes growth_sq = size_sq_ / (size_before > Lanes{} ? size_before : all(1));
    growth_sq_ = is_open_ ? larger(growth_sq, growth_sq_) : growth_sq_;
    last_sq_ = is_open_ ? size_sq_ : last_sq_;
    before_sq_ = is_open_ ? size_before : before_sq_;
  }

  // True if the remainder is below the precision. Estimate of the next term: the last term times
  // the largest growth so far; in case the last term vanishes, the one before times the growth
  // squared. If every second term vanishes, two small terms in a row suffice. One term never
  // suffices: near an unstable rotation small terms grow fast.
  Mask isRestBelowPrecision() const {
    const Mask are_small = larger(last_sq_, before_sq_) <= precision_sq_;
    if (order_ < kLeastOrder) return are_small;
    const double inverse_order_sq = 1.0 / (order_ * order_);
    const Lanes next = larger(last_sq_, before_sq_ * growth_sq_ * inverse_order_sq) * growth_sq_;
    return are_small | (next <= precision_sq_);
  }

  // Returns the fraction of the duration up to which the series has its precision: 1, or less if
  // kMaxOrder terms are not enough.
  Lanes reach() const {
    Lanes fraction = all(1);
    if (!anyOf(is_open_)) return fraction;
    for (int i = 0; i < kWidth; ++i) {
      if (!is_open_[i]) continue;
      const double last = reachOfTerm(order_, last_sq_[i] / precision_sq_[i]);
      const double before = reachOfTerm(order_ - 1, before_sq_[i] / precision_sq_[i]);
      fraction[i] = before < last ? before : last;
    }
    return fraction;
  }

  // Returns the fraction of the duration at which term k, whose squared size is `excess` times the
  // squared precision, is equal to the precision.
  static double reachOfTerm(int k, double excess) {
    return excess > 1 ? portable::pow(excess, -0.5 / k) : 1.0;
  }

  const Inverse& inverse_;
  Lanes duration_;
  Lanes precision_sq_;
  Lanes inverse_energy_;
  Mask is_open_;  // bodies that need more terms
  int order_ = 0;
  // Squared sizes of terms, in the norms of K^-1 and of the quaternion.
  Lanes size_sq_ = all(1), last_sq_ = all(1), before_sq_ = all(1);
  Lanes growth_sq_ = Lanes{};  // largest squared ratio of a term to the one before
  Coefficient c_[kMaxOrder + 1];
};

struct Motions {
  Orientations orientation;
  Vectors displacement_W;
  Pairs motion;  // in B
};
inline Motions select(const Mask& mask, const Motions& a, const Motions& b) {
  return {select(mask, a.orientation, b.orientation),
          select(mask, a.displacement_W, b.displacement_W), select(mask, a.motion, b.motion)};
}

/// Returns orientations after a turn by rotation vectors in B [rad].
inline Orientations turned(const Orientations& start, const Vectors& rotation) {
  const Lanes angle = squareRoot(dot(rotation, rotation));
  Lanes cosine = all(1), scale = all(0.5);
  for (int i = 0; i < kWidth; ++i) {
    if (!(angle[i] > 0)) continue;
    cosine[i] = portable::cos(angle[i] / 2);
    scale[i] = portable::sin(angle[i] / 2) / angle[i];
  }
  return normalized(start * Orientations{scale * rotation, cosine});
}

/// Moves bodies with constant velocities in W over `duration` [s]. Leaves the momentum as it is.
inline Motions glide(const Motions& start, const Lanes& duration) {
  const Spatials& x = start.motion.twist;
  const Vectors velocity_W = start.orientation.toWorld(x.linear);
  Motions end = start;
  end.orientation = turned(start.orientation, duration * x.angular);
  end.displacement_W = start.displacement_W + duration * velocity_W;
  end.motion.twist.linear = end.orientation.toBody(velocity_W);
  return end;
}

/// Moves bodies with constant twist over `duration` [s]. The end twist follows from the world
/// momenta, which are conserved.
template <class Inverse>
Motions coast(const Inverse& inverse, const Motions& start, const Lanes& duration) {
  const Vectors displacement_W = start.orientation.toWorld(duration * start.motion.twist.linear);
  const Spatials& m = start.motion.momentum;
  const Vectors p_W = start.orientation.toWorld(m.linear);
  const Vectors l_W = start.orientation.toWorld(m.angular) - cross(displacement_W, p_W);
  Motions end;
  end.orientation = turned(start.orientation, duration * start.motion.twist.angular);
  end.displacement_W = start.displacement_W + displacement_W;
  end.motion.momentum = {end.orientation.toBody(l_W), end.orientation.toBody(p_W)};
  end.motion.twist = inverse * end.motion.momentum;
  return end;
}

/// Moves active bodies without loads, docs/theory.md eq. (22), see FlightKernel::drift. A body that
/// the fluid settles has its turning in the kick, eq. (124).
template <class Matrices>
void drift(FlightLanes& bodies, int at, const Mask& active) {
  constexpr int kMaxPieces = 1024;  // largest number of series, one after another
  const Lanes zero = Lanes{};
  const Matrices inverse(bodies.inverse_inertia, at);
  const Lanes precision = load(bodies.precision + at);
  Motions now{loadOrientation(bodies.orientation, at),
              load(bodies.displacement_W, at),
              {load6(bodies.twist_B, at), load6(bodies.momentum_B, at)}};
  const Lanes energy = inner(now.motion, now.motion);
  const Mask moves = active & (energy > zero);
  const Lanes duration = load(bodies.drift_time + at);
  Lanes left = moves ? duration : zero;
  if (bodies.has_resistance) {
    const Mask may_glide = moves & (load(bodies.settling + at) > zero);
    if (anyOf(may_glide)) {
      const Spatials turning = turningWrench(Matrices(bodies.inertia, at), now.motion);
      const Mask glides = may_glide & settledOf<Matrices>(bodies, at, now.motion, turning);
      now = select(glides, glide(now, duration), now);
      left = glides ? zero : left;
    }
  }
  for (int i = 0; i < kMaxPieces && anyOf(left > zero); ++i) {
    const Mask is_left = left > zero;
    const auto end = MotionSeries<Matrices>(inverse, now.motion, left, precision, is_left).end();
    Motions next;
    next.orientation = normalized(now.orientation * end.turn);
    next.displacement_W = now.displacement_W + next.orientation.toWorld(end.displacement);
    next.motion = {inverse * end.momentum, end.momentum};
    now = select(is_left, next, now);
    left = left - end.fraction * left;
  }
  const Mask is_left = left > zero;
  if (anyOf(is_left)) {
    now = select(is_left, coast(inverse, now, left), now);
    store(bodies.is_coarse + at, is_left ? all(1) : load(bodies.is_coarse + at));
  }
  // Scales the motion down to its energy before the flow. The momentum is recomputed from the
  // twist: rounding of K^-1 grows with the condition of K.
  now.motion.momentum = Matrices(bodies.inertia, at) * now.motion.twist;
  const Lanes after = inner(now.motion, now.motion);
  const Lanes removed = (moves & (after > energy)) ? 0.5 * (after - energy) : zero;
  store(bodies.energy_removed + at, load(bodies.energy_removed + at) + removed);
  const Pairs start{load6(bodies.twist_B, at), load6(bodies.momentum_B, at)};
  now.motion = select(moves, scaleWithin(after, energy) * now.motion, start);
  storeOrientation(bodies.orientation, at, now.orientation);
  // One by one: GCC 12 warns of a loop over them.
  store(bodies.displacement_W[0] + at, now.displacement_W.x);
  store(bodies.displacement_W[1] + at, now.displacement_W.y);
  store(bodies.displacement_W[2] + at, now.displacement_W.z);
  store6(bodies.twist_B, at, now.motion.twist);
  store6(bodies.momentum_B, at, now.motion.momentum);
}

}  // namespace
}  // namespace ambient
