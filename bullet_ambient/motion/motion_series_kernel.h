#pragma once

#include <math.h>

#include "bullet_ambient/motion/motion_series.h"

// Included once by each motion_series_<instruction set>.cpp, which is compiled for that set.

namespace ambient {
namespace {

constexpr int kLeastOrder = 3, kMaxOrder = 18;

/// Three numbers and a zero, in one register or in two. GCC and Clang have IEEE 754 arithmetic per
/// lane for such types; without AVX they must not be passed with four lanes.
#if defined(__AVX2__)
using Lanes = double __attribute__((vector_size(32)));
struct Quad {
  Lanes lanes;

  double operator[](int i) const { return lanes[i]; }
};
inline Quad quad(double x, double y, double z) { return {Lanes{x, y, z, 0}}; }
inline Quad operator+(Quad a, Quad b) { return {a.lanes + b.lanes}; }
inline Quad operator-(Quad a, Quad b) { return {a.lanes - b.lanes}; }
inline Quad operator*(Quad a, Quad b) { return {a.lanes * b.lanes}; }
inline Quad operator*(double s, Quad a) { return {s * a.lanes}; }
inline Quad rotated(Quad a) { return {__builtin_shufflevector(a.lanes, a.lanes, 1, 2, 0, 3)}; }
#else
using Lanes = double __attribute__((vector_size(16)));
struct Quad {
  Lanes low, high;

  double operator[](int i) const { return i < 2 ? low[i] : high[i - 2]; }
};
inline Quad quad(double x, double y, double z) { return {Lanes{x, y}, Lanes{z, 0}}; }
inline Quad operator+(Quad a, Quad b) { return {a.low + b.low, a.high + b.high}; }
inline Quad operator-(Quad a, Quad b) { return {a.low - b.low, a.high - b.high}; }
inline Quad operator*(Quad a, Quad b) { return {a.low * b.low, a.high * b.high}; }
inline Quad operator*(double s, Quad a) { return {s * a.low, s * a.high}; }
inline Quad rotated(Quad a) {
  return {__builtin_shufflevector(a.low, a.high, 1, 2),
          __builtin_shufflevector(a.low, a.high, 0, 3)};
}
#endif

inline Quad quad(const double* from) { return quad(from[0], from[1], from[2]); }
inline double dot(Quad a, Quad b) {
  const Quad product = a * b;
  return product[0] + product[1] + product[2];
}
inline double larger(double a, double b) { return a > b ? a : b; }

/// A vector and its components in the order (y, z, x): products of both give a cross product in
/// the order (z, x, y), which is turned back once after a sum of many.
struct Cyclic {
  Quad xyz, yzx;

  void set(Quad a) {
    xyz = a;
    yzx = rotated(a);
  }
};
inline Quad crossed(const Cyclic& a, const Cyclic& b) { return a.xyz * b.yzx - a.yzx * b.xyz; }

/// K^-1, whose columns are split into those of w and of v.
class FullInverse {
 public:
  explicit FullInverse(const double* inverse_inertia) {
    for (int column = 0; column < 6; ++column) {
      angular_[column] = quad(inverse_inertia + 6 * column);
      linear_[column] = quad(inverse_inertia + 6 * column + 3);
    }
  }
  Quad angular(Quad l, Quad p) const { return product(angular_, l, p); }
  Quad linear(Quad l, Quad p) const { return product(linear_, l, p); }

 private:
  static Quad product(const Quad (&columns)[6], Quad l, Quad p) {
    return (l[0] * columns[0] + l[1] * columns[1] + l[2] * columns[2]) +
           (p[0] * columns[3] + p[1] * columns[4] + p[2] * columns[5]);
  }

  Quad angular_[6], linear_[6];
};

/// The same of a body with three planes of symmetry.
class DiagonalInverse {
 public:
  explicit DiagonalInverse(const double* m)
      : angular_(quad(m[0], m[7], m[14])), linear_(quad(m[21], m[28], m[35])) {}
  Quad angular(Quad l, Quad) const { return angular_ * l; }
  Quad linear(Quad, Quad p) const { return linear_ * p; }

 private:
  Quad angular_, linear_;
};

/// Kirchhoff's equations in body axes are bilinear, so that the coefficients of their power series
/// follow from one another by sums of cross products (Jorba and Zou 2005 on such integrators):
///   l' = l x w + p x v,   p' = p x w,   (w, v) = K^-1 (l, p),
///   r' = r x w + v,       q' = 1/2 q w,
/// r being the way from the start in body axes, y = y_0 + R r, and q the turn since the start.
/// Coefficients are scaled to t = fraction of the duration.
template <class Inverse>
class MotionSeries {
 public:
  explicit MotionSeries(const SeriesStart& start)
      : duration_(start.duration),
        precision_sq_(start.precision * start.precision),
        inverse_(start.inverse_inertia) {
    const Quad zero = quad(0, 0, 0);
    Coefficient& first = c_[0];
    first.l.set(quad(start.momentum));
    first.p.set(quad(start.momentum + 3));
    first.w.set(quad(start.twist));
    first.v.set(quad(start.twist + 3));
    first.r.set(zero);
    first.turn.set(zero);
    first.cosine = 1;
    per_energy_ = 1 / (dot(first.l.xyz, first.w.xyz) + dot(first.p.xyz, first.v.xyz));
    size_sq_[0] = 1;
    do {
      addTerm();
      is_precise_ = isRestBelowPrecision();
    } while (!is_precise_ && order_ < kMaxOrder);
  }

  SeriesEnd end() const {
    const double fraction = is_precise_ ? 1 : reach();
    Quad l = c_[order_].l.xyz, p = c_[order_].p.xyz, r = c_[order_].r.xyz;
    Quad turn = c_[order_].turn.xyz;
    double cosine = c_[order_].cosine;
    for (int k = order_ - 1; k >= 0; --k) {
      const Coefficient& c = c_[k];
      l = c.l.xyz + fraction * l;
      p = c.p.xyz + fraction * p;
      r = c.r.xyz + fraction * r;
      turn = c.turn.xyz + fraction * turn;
      cosine = c.cosine + fraction * cosine;
    }
    return {fraction,
            {l[0], l[1], l[2], p[0], p[1], p[2]},
            {r[0], r[1], r[2]},
            {turn[0], turn[1], turn[2], cosine}};
  }

 private:
  struct Coefficient {
    Cyclic l, p, w, v, r;
    Cyclic turn;  // vector part of q
    double cosine;
  };

  void addTerm() {
    const int k = order_;
    // r and the vector part of q begin with a term that is zero, the cosine with 1.
    Quad l = crossed(c_[0].l, c_[k].w) + crossed(c_[0].p, c_[k].v);
    Quad p = crossed(c_[0].p, c_[k].w);
    Quad scaled = c_[k].w.xyz;
    const Quad zero = quad(0, 0, 0);
    Quad r = zero, turn = zero, along = zero;
    for (int i = 1; i <= k; ++i) {
      const Coefficient& a = c_[i];
      const Coefficient& b = c_[k - i];
      l = l + (crossed(a.l, b.w) + crossed(a.p, b.v));
      p = p + crossed(a.p, b.w);
      r = r + crossed(a.r, b.w);
      turn = turn + crossed(a.turn, b.w);
      scaled = scaled + a.cosine * b.w.xyz;
      along = along + a.turn.xyz * b.w.xyz;
    }
    const double step = duration_ / (k + 1);
    Coefficient& next = c_[k + 1];
    next.l.set(step * rotated(l));
    next.p.set(step * rotated(p));
    next.w.set(inverse_.angular(next.l.xyz, next.p.xyz));
    next.v.set(inverse_.linear(next.l.xyz, next.p.xyz));
    next.r.set(step * (rotated(r) + c_[k].v.xyz));
    next.turn.set(step / 2 * (rotated(turn) + scaled));
    next.cosine = -step / 2 * (along[0] + along[1] + along[2]);
    ++order_;
    const double energy = dot(next.l.xyz, next.w.xyz) + dot(next.p.xyz, next.v.xyz);
    size_sq_[order_] =
        larger(energy * per_energy_, dot(next.turn.xyz, next.turn.xyz) + next.cosine * next.cosine);
    growth_sq_ = larger(growth_sq_, size_sq_[order_] / size_sq_[k]);
  }

  // The next term is taken to grow at most as any before it, from the last term or, in case that
  // happens to vanish, over two terms from the one before. Where every second term vanishes there
  // is no such growth, and two small terms in a row must do. The first term says too little: a
  // body that a small disturbance turns out of its course has small terms that grow fast.
  bool isRestBelowPrecision() const {
    const double last = size_sq_[order_], before = size_sq_[order_ - 1];
    if (larger(last, before) <= precision_sq_) return true;
    return order_ >= kLeastOrder &&
           larger(last, before * growth_sq_ / (order_ * order_)) * growth_sq_ <= precision_sq_;
  }

  // Largest fraction of the duration at which the series is precise.
  double reach() const {
    const double last = reachOfTerm(order_);
    const double before = reachOfTerm(order_ - 1);
    return before < last ? before : last;
  }

  double reachOfTerm(int k) const {
    const double excess = size_sq_[k] / precision_sq_;
    return excess > 1 ? ::pow(excess, -0.5 / k) : 1.0;
  }

  double duration_;
  double precision_sq_;
  double per_energy_;
  int order_ = 0;
  bool is_precise_ = false;
  double growth_sq_ = 0;  // largest ratio of a term to the one before it
  Inverse inverse_;
  Coefficient c_[kMaxOrder + 1];
  double size_sq_[kMaxOrder + 1];  // in the norms of K^-1 and of the quaternion
};

SeriesEnd sumMotionSeries(const SeriesStart& start) {
  return start.has_diagonal_inertia ? MotionSeries<DiagonalInverse>(start).end()
                                    : MotionSeries<FullInverse>(start).end();
}

}  // namespace
}  // namespace ambient
