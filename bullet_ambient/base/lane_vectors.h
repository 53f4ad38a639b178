#pragma once

// 3-vectors with one number per lane in each component, or of doubles. Functions are in an unnamed
// namespace, for sources compiled once per instruction set; see instruction_set.h.

#if defined(__FAST_MATH__)
#error "-ffast-math reorders operations; results must have the same bits everywhere"
#endif

namespace ambient {

/// `Real`: a number per lane, or double.
template <class Real>
struct VectorsOf {
  Real x, y, z;
};

namespace {

/// Returns a vector of numbers in all lanes.
template <class Lanes, class Number>
inline VectorsOf<Lanes> inAllLanes(const Number (&v)[3]) {
  return {Lanes{} + v[0], Lanes{} + v[1], Lanes{} + v[2]};
}
template <class Real>
inline VectorsOf<Real> operator+(const VectorsOf<Real>& a, const VectorsOf<Real>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class Real>
inline VectorsOf<Real> operator-(const VectorsOf<Real>& a, const VectorsOf<Real>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class Real>
inline VectorsOf<Real> operator*(const Real& s, const VectorsOf<Real>& a) {
  return {s * a.x, s * a.y, s * a.z};
}
template <class Real>
inline Real dot(const VectorsOf<Real>& a, const VectorsOf<Real>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class Real>
inline VectorsOf<Real> cross(const VectorsOf<Real>& a, const VectorsOf<Real>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
/// Returns a where the mask holds, else b.
template <class Mask, class Real>
inline VectorsOf<Real> select(const Mask& mask, const VectorsOf<Real>& a,
                              const VectorsOf<Real>& b) {
  return {mask ? a.x : b.x, mask ? a.y : b.y, mask ? a.z : b.z};
}

}  // namespace
}  // namespace ambient
