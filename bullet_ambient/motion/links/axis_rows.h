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

/// Returns K x.
inline Spatial times(const LinkState& link, const Spatial& x) {
  return times(load(link.inertia), load(link.coupling_transposed), x);
}

// Brings a twist from the frame of a link's parent to the link's frame, X x of docs/theory.md eq.
// (76); and a wrench back, X^T f.
inline Spatial toLink(const LinkState& link, const Spatial& x) {
  const Matrix to_link = load(link.offset_transposed);
  return {to_link * x.angular, to_link * (x.linear + cross(x.angular, load(link.translation)))};
}
inline Spatial toParent(const LinkState& link, const Spatial& f) {
  const Matrix to_parent = load(link.offset);
  const Row force = to_parent * f.linear;
  return {to_parent * f.angular + cross(load(link.translation), force), force};
}

// Rotates the first six coordinates into the base's frame; and back into W.
inline Spatial ofBase(const LinkState& base, const double* u) {
  const Matrix to_base = load(base.rotation_W_transposed);
  return {to_base * rowOf(u), to_base * rowOf(u + 3)};
}
inline void putInWorld(const LinkState& base, const Spatial& a, double* u) {
  const Matrix to_world = load(base.rotation_W);
  AxisPair a_W;
  store(a_W, {to_world * a.angular, to_world * a.linear});
  for (int i = 0; i < 3; ++i) {
    u[i] = a_W.angular.at[i];
    u[3 + i] = a_W.linear.at[i];
  }
}

// Returns S q' of the link's joint.
inline Spatial alongAxes(const LinkState& link, const double* velocity) {
  Spatial x{zeroRow(), zeroRow()};
  for (int i = 0; i < link.axis_count; ++i) x = x + velocity[i] * load(link.axis[i]);
  return x;
}

// Brings an inertia from a link's frame to its parent's, docs/theory.md eq. (4) and (5).
inline Inertia toParent(const LinkState& link, const Inertia& I) {
  const Matrix R = load(link.offset), R_transposed = load(link.offset_transposed);
  const Row t = load(link.translation);
  const Matrix M = R * I.translation * R_transposed;
  const Matrix C = R * I.coupling * R_transposed;
  const Matrix C_parent = C + crossColumns(t, M);
  // A - C [t] + [t] C_parent^T
  const Matrix A = R * I.rotation * R_transposed + transposed(crossColumns(t, transposed(C))) +
                   crossColumns(t, transposed(C_parent));
  return {A, C_parent, M};
}

// Inverts a symmetric matrix of `n` rows. Returns false if it is not positive definite.
inline bool invert(const double (&D)[3][3], int n, double (&inverse)[3][3]) {
  double lower[3][3] = {}, per_pivot[3] = {};
  bool is_positive = true;
  for (int i = 0; i < n; ++i) {
    double scaled[3] = {}, pivot = D[i][i];
    for (int j = 0; j < i; ++j) {
      scaled[j] = D[i][j];
      for (int k = 0; k < j; ++k) scaled[j] -= scaled[k] * lower[j][k];
      lower[i][j] = scaled[j] * per_pivot[j];
      pivot -= scaled[j] * lower[i][j];
    }
    per_pivot[i] = 1 / pivot;
    is_positive = is_positive && pivot > 0 && per_pivot[i] <= __DBL_MAX__;
  }
  for (int j = 0; j < n; ++j) {
    double x[3] = {0, 0, 0};
    x[j] = 1;
    for (int i = j + 1; i < n; ++i)
      for (int k = j; k < i; ++k) x[i] -= lower[i][k] * x[k];
    for (int i = n - 1; i >= 0; --i) {
      x[i] *= per_pivot[i];
      for (int k = i + 1; k < n; ++k) x[i] -= lower[k][i] * x[k];
      inverse[i][j] = x[i];
    }
  }
  return is_positive;
}

// Factors a 6x6 inertia.
inline void factorBase(const InertiaBlocks& I, BaseFactor& factor) {
  double K[6][6];  // its lower half
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      K[i][j] = I.rotation.column[j].at[i];
      K[3 + i][j] = I.coupling.column[i].at[j];
      K[3 + i][3 + j] = I.translation.column[j].at[i];
    }
  factor.is_positive = true;
  for (int i = 0; i < 6; ++i) {
    double scaled[6], pivot = K[i][i];
    for (int j = 0; j < i; ++j) {
      scaled[j] = K[i][j];
      for (int k = 0; k < j; ++k) scaled[j] -= scaled[k] * factor.lower[j][k];
      factor.lower[i][j] = scaled[j] * factor.per_pivot[j];
      pivot -= scaled[j] * factor.lower[i][j];
    }
    factor.is_positive = factor.is_positive && pivot > 0;
    factor.per_pivot[i] = 1 / pivot;
  }
}

// Replaces b by the solution x of L D L^T x = b.
inline void answer(const BaseFactor& factor, double* b) noexcept {
  for (int i = 1; i < 6; ++i)
    for (int j = 0; j < i; ++j) b[i] -= factor.lower[i][j] * b[j];
  for (int i = 5; i >= 0; --i) {
    b[i] *= factor.per_pivot[i];
    for (int j = i + 1; j < 6; ++j) b[i] -= factor.lower[j][i] * b[j];
  }
}

}  // namespace

}  // namespace ambient
