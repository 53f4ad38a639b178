#pragma once

#if defined(__FAST_MATH__)
#error "-ffast-math reorders operations; results must have the same bits everywhere"
#endif

#include "bullet_ambient/motion/links/link_state.h"

// Arithmetic with AxisRow in registers, for sources that are compiled once per instruction set, see
// base/instruction_set.h. No operation is fused and each sum has a fixed order, so that all
// instruction sets give the same bits. A Row holds three components; its fourth lane is 0.

namespace ambient {
namespace {

#if defined(__AVX2__)

struct Row {
  double __attribute__((vector_size(32))) all;
};
inline Row operator+(const Row& a, const Row& b) { return {a.all + b.all}; }
inline Row operator-(const Row& a, const Row& b) { return {a.all - b.all}; }
inline Row operator*(const Row& a, const Row& b) { return {a.all * b.all}; }
inline Row operator*(double s, const Row& a) { return {s * a.all}; }
/// Returns component kAxis in all lanes.
template <int kAxis>
Row spread(const Row& a) {
  return {__builtin_shufflevector(a.all, a.all, kAxis, kAxis, kAxis, kAxis)};
}
/// Returns (y, z, x).
inline Row nextAxes(const Row& a) { return {__builtin_shufflevector(a.all, a.all, 1, 2, 0, 3)}; }
inline double sum(const Row& a) { return a.all[0] + a.all[1] + a.all[2]; }

struct Matrix {
  Row column[3];
};
inline Matrix transposed(const Matrix& m) {
  const auto &x = m.column[0].all, &y = m.column[1].all, &z = m.column[2].all;
  const auto even = __builtin_shufflevector(x, y, 0, 4, 2, 6);
  const auto odd = __builtin_shufflevector(x, y, 1, 5, 3, 7);
  return {{{__builtin_shufflevector(even, z, 0, 1, 4, 7)},
           {__builtin_shufflevector(odd, z, 0, 1, 5, 7)},
           {__builtin_shufflevector(even, z, 2, 3, 6, 7)}}};
}

#else

struct Row {
  double __attribute__((vector_size(16))) xy, z;
};
inline Row operator+(const Row& a, const Row& b) { return {a.xy + b.xy, a.z + b.z}; }
inline Row operator-(const Row& a, const Row& b) { return {a.xy - b.xy, a.z - b.z}; }
inline Row operator*(const Row& a, const Row& b) { return {a.xy * b.xy, a.z * b.z}; }
inline Row operator*(double s, const Row& a) { return {s * a.xy, s * a.z}; }
template <int kAxis>
Row spread(const Row& a) {
  constexpr int kLane = kAxis % 2;
  const auto& part = kAxis < 2 ? a.xy : a.z;
  const auto both = __builtin_shufflevector(part, part, kLane, kLane);
  return {both, both};
}
inline Row nextAxes(const Row& a) {
  return {__builtin_shufflevector(a.xy, a.z, 1, 2), __builtin_shufflevector(a.xy, a.z, 0, 3)};
}
inline double sum(const Row& a) { return a.xy[0] + a.xy[1] + a.z[0]; }

struct Matrix {
  Row column[3];
};
inline Matrix transposed(const Matrix& m) {
  const Row &x = m.column[0], &y = m.column[1], &z = m.column[2];
  return {{{__builtin_shufflevector(x.xy, y.xy, 0, 2), __builtin_shufflevector(z.xy, z.z, 0, 3)},
           {__builtin_shufflevector(x.xy, y.xy, 1, 3), __builtin_shufflevector(z.xy, z.z, 1, 3)},
           {__builtin_shufflevector(x.z, y.z, 0, 2), z.z}}};
}

#endif

inline Row load(const AxisRow& from) {
  Row row;
  __builtin_memcpy(&row, &from, sizeof row);
  return row;
}
inline void store(AxisRow& to, const Row& row) { __builtin_memcpy(&to, &row, sizeof row); }
inline Row rowOf(const double* xyz) { return load({{xyz[0], xyz[1], xyz[2], 0}}); }
inline Row zeroRow() { return load({{0, 0, 0, 0}}); }

inline double dot(const Row& a, const Row& b) { return sum(a * b); }
inline Row cross(const Row& a, const Row& b) { return nextAxes(a * nextAxes(b) - nextAxes(a) * b); }

inline Matrix load(const AxisMatrix& from) {
  return {{load(from.column[0]), load(from.column[1]), load(from.column[2])}};
}
inline void store(AxisMatrix& to, const Matrix& m) {
  for (int i = 0; i < 3; ++i) store(to.column[i], m.column[i]);
}
inline Row operator*(const Matrix& m, const Row& a) {
  return m.column[0] * spread<0>(a) + m.column[1] * spread<1>(a) + m.column[2] * spread<2>(a);
}
inline Matrix operator*(const Matrix& m, const Matrix& n) {
  return {{m * n.column[0], m * n.column[1], m * n.column[2]}};
}
inline Matrix operator+(const Matrix& m, const Matrix& n) {
  return {{m.column[0] + n.column[0], m.column[1] + n.column[1], m.column[2] + n.column[2]}};
}
inline Matrix operator*(double s, const Matrix& m) {
  return {{s * m.column[0], s * m.column[1], s * m.column[2]}};
}
/// Returns m - a b^T.
inline Matrix lessProduct(const Matrix& m, const Row& a, const Row& b) {
  return {{m.column[0] - a * spread<0>(b), m.column[1] - a * spread<1>(b),
           m.column[2] - a * spread<2>(b)}};
}
/// Returns [t]x m.
inline Matrix crossColumns(const Row& t, const Matrix& m) {
  return {{cross(t, m.column[0]), cross(t, m.column[1]), cross(t, m.column[2])}};
}

/// Twist, acceleration, momentum or wrench; the rotation part is `angular`.
struct Spatial {
  Row angular, linear;
};
inline Spatial load(const AxisPair& from) { return {load(from.angular), load(from.linear)}; }
inline void store(AxisPair& to, const Spatial& a) {
  store(to.angular, a.angular);
  store(to.linear, a.linear);
}
inline Spatial operator+(const Spatial& a, const Spatial& b) {
  return {a.angular + b.angular, a.linear + b.linear};
}
inline Spatial operator-(const Spatial& a, const Spatial& b) {
  return {a.angular - b.angular, a.linear - b.linear};
}
inline Spatial operator*(double s, const Spatial& a) { return {s * a.angular, s * a.linear}; }
inline double dot(const Spatial& a, const Spatial& b) {
  return sum(a.angular * b.angular + a.linear * b.linear);
}

/// Symmetric 6x6 inertia by blocks: (rotation, coupling; coupling^T, translation).
struct Inertia {
  Matrix rotation, coupling, translation;
};
inline Inertia load(const InertiaBlocks& from) {
  return {load(from.rotation), load(from.coupling), load(from.translation)};
}
inline void store(InertiaBlocks& to, const Inertia& K) {
  store(to.rotation, K.rotation);
  store(to.coupling, K.coupling);
  store(to.translation, K.translation);
}
/// Returns K x.
inline Spatial times(const Inertia& K, const Matrix& coupling_transposed, const Spatial& x) {
  return {K.rotation * x.angular + K.coupling * x.linear,
          coupling_transposed * x.angular + K.translation * x.linear};
}

}  // namespace
}  // namespace ambient
