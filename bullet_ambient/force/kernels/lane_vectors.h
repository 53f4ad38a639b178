#pragma once

// 3-vectors with one number per lane in each component, for sources compiled once per instruction
// set; see instruction_set.h.

#if defined(__FAST_MATH__)
#error "-ffast-math reorders operations; results must have the same bits everywhere"
#endif

namespace ambient {
namespace {

template <class Lanes>
struct VectorsOf {
  Lanes x, y, z;
};
/// Returns a vector of numbers in all lanes.
template <class Lanes, class Number>
inline VectorsOf<Lanes> inAllLanes(const Number (&v)[3]) {
  return {Lanes{} + v[0], Lanes{} + v[1], Lanes{} + v[2]};
}
template <class Lanes>
inline VectorsOf<Lanes> operator+(const VectorsOf<Lanes>& a, const VectorsOf<Lanes>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class Lanes>
inline VectorsOf<Lanes> operator-(const VectorsOf<Lanes>& a, const VectorsOf<Lanes>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class Lanes>
inline VectorsOf<Lanes> operator*(const Lanes& s, const VectorsOf<Lanes>& a) {
  return {s * a.x, s * a.y, s * a.z};
}
template <class Lanes>
inline Lanes dot(const VectorsOf<Lanes>& a, const VectorsOf<Lanes>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class Lanes>
inline VectorsOf<Lanes> cross(const VectorsOf<Lanes>& a, const VectorsOf<Lanes>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

}  // namespace
}  // namespace ambient
