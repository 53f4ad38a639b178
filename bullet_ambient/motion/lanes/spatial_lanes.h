#pragma once

#include <type_traits>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/lanes.h"
#include "bullet_ambient/motion/lanes/flight_lanes.h"

// Mathematics of rigid bodies: of one body per lane of a register, Real = Lanes, or of a single
// body, Real = double. Both make the same operations, so their bits are equal. No operation is
// fused and lanes are independent, so that every instruction set gives the same bits. For sources
// that are compiled once per instruction set, see force/kernels/lanes.h, and with one_body.h for
// ordinary ones.

namespace ambient {

namespace {

using Lanes = Doubles;
using Vectors = VectorsOf<Lanes>;

/// Result of a comparison: a mask of lanes, or bool.
template <class Real>
using MaskOf = decltype(Real{} < Real{});

template <class Real = Lanes>
inline Real all(double value) {
  return value - Real{};
}

inline bool anyOf(bool is_true) { return is_true; }
inline double squareRoot(double x) { return __builtin_sqrt(x); }

/// Returns the larger number; b where a is NaN.
template <class Real>
inline Real larger(const Real& a, const Real& b) {
  return a > b ? a : b;
}

/// Returns the factor on a motion that brings its energy down to the allowed one; 1 if it has no
/// more.
template <class Real>
inline Real scaleWithin(const Real& energy, const Real& allowed) {
  const Real one = all<Real>(1);
  const MaskOf<Real> gains = energy > allowed;
  return squareRoot(gains ? allowed / (gains ? energy : one) : one);
}

/// Returns f(x) where the mask holds, else y. `f`: function of one number.
template <class Real, class Function>
inline Real resultsWhere(const MaskOf<Real>& mask, const Function& f, const Real& x, Real y) {
  if constexpr (std::is_same_v<Real, double>) {
    return mask ? f(x) : y;
  } else {
    for (int i = 0; i < kWidth; ++i)
      if (mask[i]) y[i] = f(x[i]);
    return y;
  }
}

/// Returns c_0 + c_1 x + c_2 x^2 + ...
template <int kTerms, class Real>
inline Real polynomial(const double (&c)[kTerms], const Real& x) {
  Real sum = all<Real>(c[kTerms - 1]);
  for (int i = kTerms - 2; i >= 0; --i) sum = c[i] + x * sum;
  return sum;
}

/// Returns log(1 + z) / z. @pre z >= 0
template <class Real>
inline Real logarithmRatio(const Real& z) {
  // 2/(2 + z) artanh(s)/s, s = z/(2 + z); the series ends where the next term is below rounding.
  constexpr double kSmall = 0.1;
  static constexpr double kSeries[] = {1, 1.0 / 3, 1.0 / 5, 1.0 / 7, 1.0 / 9, 1.0 / 11, 1.0 / 13};
  const Real scale = 1 / (2 + z);
  const Real s = z * scale;
  const Real ratio = 2 * scale * polynomial(kSeries, s * s);
  const MaskOf<Real> is_large = !(z <= all<Real>(kSmall));
  if (!anyOf(is_large)) return ratio;
  return resultsWhere(
      is_large, [](double x) { return portable::log1p(x) / x; }, z, ratio);
}

/// Returns tan(x). @pre x >= 0
template <class Real>
inline Real tangent(const Real& x) {
  constexpr double kSmall = 0.1;  // the first term left out is below rounding
  static constexpr double kSeries[] = {
      1.0,         1.0 / 3,         2.0 / 15,          17.0 / 315,
      62.0 / 2835, 1382.0 / 155925, 21844.0 / 6081075, 929569.0 / 638512875};
  const Real t = x * polynomial(kSeries, x * x);
  const MaskOf<Real> is_large = !(x <= all<Real>(kSmall));
  if (!anyOf(is_large)) return t;
  return resultsWhere(is_large, portable::tan, x, t);
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
inline Orientations loadOrientation(const FlightLane (&from)[4], int at) {
  return {load(from, at), load(from[3] + at)};
}
inline void storeOrientation(FlightLane (&to)[4], int at, const Orientations& q) {
  store(to, at, q.u);
  store(to[3] + at, q.w);
}
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

using Spatials = SpatialsOf<Lanes>;

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
template <class Real>
inline SpatialsOf<Real> operator+(const SpatialsOf<Real>& a, const SpatialsOf<Real>& b) {
  return {a.angular + b.angular, a.linear + b.linear};
}
template <class Real>
inline SpatialsOf<Real> operator-(const SpatialsOf<Real>& a, const SpatialsOf<Real>& b) {
  return {a.angular - b.angular, a.linear - b.linear};
}
template <class Real>
inline SpatialsOf<Real> operator*(const Real& s, const SpatialsOf<Real>& a) {
  return {s * a.angular, s * a.linear};
}
template <class Real>
inline Real dot(const SpatialsOf<Real>& a, const SpatialsOf<Real>& b) {
  return dot(a.angular, b.angular) + dot(a.linear, b.linear);
}
template <class Real>
inline SpatialsOf<Real> select(const MaskOf<Real>& mask, const SpatialsOf<Real>& a,
                               const SpatialsOf<Real>& b) {
  return {select(mask, a.angular, b.angular), select(mask, a.linear, b.linear)};
}

/// Twists x and momenta K x: DualPair.
template <class Real>
struct PairsOf {
  SpatialsOf<Real> twist, momentum;
};
using Pairs = PairsOf<Lanes>;

template <class Real>
inline PairsOf<Real> operator+(const PairsOf<Real>& a, const PairsOf<Real>& b) {
  return {a.twist + b.twist, a.momentum + b.momentum};
}
template <class Real>
inline PairsOf<Real> operator-(const PairsOf<Real>& a, const PairsOf<Real>& b) {
  return {a.twist - b.twist, a.momentum - b.momentum};
}
template <class Real>
inline PairsOf<Real> operator*(const Real& s, const PairsOf<Real>& a) {
  return {s * a.twist, s * a.momentum};
}
template <class Real>
inline Real inner(const PairsOf<Real>& a, const PairsOf<Real>& b) {
  return dot(a.twist, b.momentum);
}
template <class Real>
inline PairsOf<Real> select(const MaskOf<Real>& mask, const PairsOf<Real>& a,
                            const PairsOf<Real>& b) {
  return {select(mask, a.twist, b.twist), select(mask, a.momentum, b.momentum)};
}

template <class Real>
inline const Real& entry(const SymmetricOf<Real>& m, int i, int j) {
  return m.entries[i < j ? symmetricEntry(i, j) : symmetricEntry(j, i)];
}
template <class Real>
inline Real& entry(SymmetricOf<Real>& m, int i, int j) {
  return m.entries[i < j ? symmetricEntry(i, j) : symmetricEntry(j, i)];
}
template <class Real>
inline SymmetricOf<Real> operator-(const SymmetricOf<Real>& a, const SymmetricOf<Real>& b) {
  SymmetricOf<Real> difference;
  for (int i = 0; i < kSymmetricEntries; ++i) difference.entries[i] = a.entries[i] - b.entries[i];
  return difference;
}
/// Returns the product of row i with the twist (a, 0).
template <class Real>
inline Real rowOfAngular(const SymmetricOf<Real>& m, int i, const VectorsOf<Real>& a) {
  return entry(m, i, 0) * a.x + entry(m, i, 1) * a.y + entry(m, i, 2) * a.z;
}
/// Returns the product with the twist (a, 0).
template <class Real>
inline SpatialsOf<Real> ofAngular(const SymmetricOf<Real>& m, const VectorsOf<Real>& a) {
  return {{rowOfAngular(m, 0, a), rowOfAngular(m, 1, a), rowOfAngular(m, 2, a)},
          {rowOfAngular(m, 3, a), rowOfAngular(m, 4, a), rowOfAngular(m, 5, a)}};
}
template <class Real>
inline SpatialsOf<Real> operator*(const SymmetricOf<Real>& m, const SpatialsOf<Real>& a) {
  const auto row = [&](int i) {
    return rowOfAngular(m, i, a.angular) +
           (entry(m, i, 3) * a.linear.x + entry(m, i, 4) * a.linear.y +
            entry(m, i, 5) * a.linear.z);
  };
  return {{row(0), row(1), row(2)}, {row(3), row(4), row(5)}};
}

/// Symmetric 6x6 matrices, one per lane.
struct FullMatrices : SymmetricOf<Lanes> {
  FullMatrices(const FlightLane (&from)[kSymmetricEntries], int at) {
    for (int i = 0; i < kSymmetricEntries; ++i) entries[i] = load(from[i] + at);
  }
};

/// Diagonal 6x6 matrices, one per lane: bodies with three planes of symmetry.
class DiagonalMatrices {
 public:
  DiagonalMatrices(const FlightLane (&entries)[kSymmetricEntries], int at) {
    for (int i = 0; i < 6; ++i) m_[i] = load(entries[symmetricEntry(i, i)] + at);
  }
  const Lanes& at(int i) const { return m_[i]; }
  Spatials operator*(const Spatials& a) const {
    return {{m_[0] * a.angular.x, m_[1] * a.angular.y, m_[2] * a.angular.z},
            {m_[3] * a.linear.x, m_[4] * a.linear.y, m_[5] * a.linear.z}};
  }

 private:
  Lanes m_[6];
};

}  // namespace

}  // namespace ambient
