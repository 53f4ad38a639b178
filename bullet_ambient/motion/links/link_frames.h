#pragma once

#include "bullet_ambient/motion/links/axis_rows.h"

// For sources that are compiled once per instruction set, see axis_rows.h.

namespace ambient {
namespace {

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

}  // namespace
}  // namespace ambient
