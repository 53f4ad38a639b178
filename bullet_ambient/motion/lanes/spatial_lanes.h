#pragma once

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/force/kernels/lanes.h"
#include "bullet_ambient/motion/lanes/flight_lanes.h"

// Functions of one number per body, side by side in the lanes of a register; vectors, orientations
// and twists, one body per lane. For sources that are compiled once per instruction set, see
// force/kernels/lanes.h. No operation is fused and lanes are independent, so that every
// instruction set gives the same bits.

namespace ambient {

namespace {

using Lanes = Doubles;
using Vectors = VectorsOf<Lanes>;

inline Lanes all(double value) { return value - Lanes{}; }

/// Returns the larger number per lane; b where a is NaN.
inline Lanes larger(const Lanes& a, const Lanes& b) { return a > b ? a : b; }

/// Returns c_0 + c_1 x + c_2 x^2 + ... per lane.
template <int kTerms>
Lanes polynomial(const double (&c)[kTerms], const Lanes& x) {
  Lanes sum = all(c[kTerms - 1]);
  for (int i = kTerms - 2; i >= 0; --i) sum = c[i] + x * sum;
  return sum;
}

/// Returns log(1 + z) / z per lane. @pre z >= 0
inline Lanes logarithmRatio(const Lanes& z) {
  // 2/(2 + z) artanh(s)/s, s = z/(2 + z); the series ends where the next term is below rounding.
  constexpr double kSmall = 0.1;
  static constexpr double kSeries[] = {1, 1.0 / 3, 1.0 / 5, 1.0 / 7, 1.0 / 9, 1.0 / 11, 1.0 / 13};
  const Lanes scale = 1 / (2 + z);
  const Lanes s = z * scale;
  Lanes ratio = 2 * scale * polynomial(kSeries, s * s);
  if (!anyOf(!(z <= all(kSmall)))) return ratio;
  for (int i = 0; i < kWidth; ++i)
    if (!(z[i] <= kSmall)) ratio[i] = portable::log1p(z[i]) / z[i];
  return ratio;
}

/// Returns tan(x) per lane. @pre x >= 0
inline Lanes tangent(const Lanes& x) {
  constexpr double kSmall = 0.1;  // the first term left out is below rounding
  static constexpr double kSeries[] = {
      1.0,         1.0 / 3,         2.0 / 15,          17.0 / 315,
      62.0 / 2835, 1382.0 / 155925, 21844.0 / 6081075, 929569.0 / 638512875};
  Lanes t = x * polynomial(kSeries, x * x);
  if (!anyOf(!(x <= all(kSmall)))) return t;
  for (int i = 0; i < kWidth; ++i)
    if (!(x[i] <= kSmall)) t[i] = portable::tan(x[i]);
  return t;
}

inline Vectors zeroVectors() { return {Lanes{}, Lanes{}, Lanes{}}; }

/// Loads the 3-vectors of the bodies in kWidth lanes from `at` on.
inline Vectors load(const FlightLane* from, int at) {
  return {load(from[0] + at), load(from[1] + at), load(from[2] + at)};
}
inline void store(FlightLane* to, int at, const Vectors& a) {
  store(to[0] + at, a.x);
  store(to[1] + at, a.y);
  store(to[2] + at, a.z);
}

/// Unit quaternions, B to W.
struct Orientations {
  Vectors u;  // vector part
  Lanes w;

  Vectors toWorld(const Vectors& a) const {
    const Vectors t = cross(u, a);
    return a + all(2) * (w * t + cross(u, t));
  }
  Vectors toBody(const Vectors& a) const {
    const Vectors t = cross(u, a);
    return a + all(2) * (cross(u, t) - w * t);
  }
};
inline Orientations operator*(const Orientations& a, const Orientations& b) {
  return {a.w * b.u + b.w * a.u + cross(a.u, b.u), a.w * b.w - dot(a.u, b.u)};
}
inline Orientations normalized(const Orientations& q) {
  const Lanes size_sq = dot(q.u, q.u) + q.w * q.w;
  const Lanes scale = 1 / squareRoot(size_sq > Lanes{} ? size_sq : all(1));
  return {scale * q.u, scale * q.w};
}
inline Orientations select(const Mask& mask, const Orientations& a, const Orientations& b) {
  return {select(mask, a.u, b.u), mask ? a.w : b.w};
}

/// Twists (w, v) or wrenches (torque, force).
struct Spatials {
  Vectors angular, linear;
};
inline Spatials load6(const FlightLane* from, int at) {
  return {load(from, at), load(from + 3, at)};
}
inline void store6(FlightLane* to, int at, const Spatials& a) {
  store(to, at, a.angular);
  store(to + 3, at, a.linear);
}
inline Spatials toWorld(const Orientations& q, const Spatials& a) {
  return {q.toWorld(a.angular), q.toWorld(a.linear)};
}
inline Spatials toBody(const Orientations& q, const Spatials& a) {
  return {q.toBody(a.angular), q.toBody(a.linear)};
}
inline Spatials operator+(const Spatials& a, const Spatials& b) {
  return {a.angular + b.angular, a.linear + b.linear};
}
inline Spatials operator-(const Spatials& a, const Spatials& b) {
  return {a.angular - b.angular, a.linear - b.linear};
}
inline Spatials operator*(const Lanes& s, const Spatials& a) {
  return {s * a.angular, s * a.linear};
}
inline Lanes dot(const Spatials& a, const Spatials& b) {
  return dot(a.angular, b.angular) + dot(a.linear, b.linear);
}
inline Spatials select(const Mask& mask, const Spatials& a, const Spatials& b) {
  return {select(mask, a.angular, b.angular), select(mask, a.linear, b.linear)};
}

/// Twists x and momenta K x, one pair per lane: DualPair.
struct Pairs {
  Spatials twist, momentum;
};
inline Pairs operator+(const Pairs& a, const Pairs& b) {
  return {a.twist + b.twist, a.momentum + b.momentum};
}
inline Pairs operator-(const Pairs& a, const Pairs& b) {
  return {a.twist - b.twist, a.momentum - b.momentum};
}
inline Pairs operator*(const Lanes& s, const Pairs& a) { return {s * a.twist, s * a.momentum}; }
inline Lanes inner(const Pairs& a, const Pairs& b) { return dot(a.twist, b.momentum); }
inline Pairs select(const Mask& mask, const Pairs& a, const Pairs& b) {
  return {select(mask, a.twist, b.twist), select(mask, a.momentum, b.momentum)};
}

/// Symmetric 6x6 matrices, one per lane.
class FullMatrices {
 public:
  FullMatrices() = default;  ///< leaves the entries uninitialised
  FullMatrices(const FlightLane (&entries)[kSymmetricEntries], int at) {
    for (int i = 0; i < kSymmetricEntries; ++i) m_[i] = load(entries[i] + at);
  }
  void storeTo(FlightLane (&entries)[kSymmetricEntries], int at) const {
    for (int i = 0; i < kSymmetricEntries; ++i) store(entries[i] + at, m_[i]);
  }

  Lanes& entry(int i, int j) { return m_[i < j ? symmetricEntry(i, j) : symmetricEntry(j, i)]; }
  const Lanes& entry(int i, int j) const {
    return m_[i < j ? symmetricEntry(i, j) : symmetricEntry(j, i)];
  }

  FullMatrices operator-(const FullMatrices& other) const {
    FullMatrices difference;
    for (int i = 0; i < kSymmetricEntries; ++i) difference.m_[i] = m_[i] - other.m_[i];
    return difference;
  }
  Spatials operator*(const Spatials& a) const {
    return {{row(0, a), row(1, a), row(2, a)}, {row(3, a), row(4, a), row(5, a)}};
  }
  /// Returns the product with the twist (a, 0).
  Spatials ofAngular(const Vectors& a) const {
    return {{half(0, a), half(1, a), half(2, a)}, {half(3, a), half(4, a), half(5, a)}};
  }

 private:
  Lanes half(int i, const Vectors& a) const {
    return entry(i, 0) * a.x + entry(i, 1) * a.y + entry(i, 2) * a.z;
  }
  Lanes row(int i, const Spatials& a) const {
    return half(i, a.angular) +
           (entry(i, 3) * a.linear.x + entry(i, 4) * a.linear.y + entry(i, 5) * a.linear.z);
  }

  Lanes m_[kSymmetricEntries];
};

/// Diagonal 6x6 matrices, one per lane: bodies with three planes of symmetry.
class DiagonalMatrices {
 public:
  DiagonalMatrices(const FlightLane (&entries)[kSymmetricEntries], int at) {
    for (int i = 0; i < 6; ++i) m_[i] = load(entries[symmetricEntry(i, i)] + at);
  }
  Spatials operator*(const Spatials& a) const {
    return {{m_[0] * a.angular.x, m_[1] * a.angular.y, m_[2] * a.angular.z},
            {m_[3] * a.linear.x, m_[4] * a.linear.y, m_[5] * a.linear.z}};
  }

 private:
  Lanes m_[6];
};

}  // namespace

}  // namespace ambient
