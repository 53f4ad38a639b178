#if defined(__FAST_MATH__)
#error "-ffast-math reorders operations; results must have the same bits everywhere"
#endif

#include "bullet_ambient/motion/links/link_kernel.h"

// Compiled once per instruction set, see base/instruction_set.h. No operation is fused and each sum
// has a fixed order, so that all instruction sets give the same bits.

namespace ambient {
namespace {

inline AxisRow operator+(const AxisRow& a, const AxisRow& b) { return {a.at + b.at}; }
inline AxisRow operator-(const AxisRow& a, const AxisRow& b) { return {a.at - b.at}; }
inline AxisRow operator*(const AxisRow& a, const AxisRow& b) { return {a.at * b.at}; }
inline AxisRow operator*(double s, const AxisRow& a) { return {s * a.at}; }
// Returns component kAxis in all lanes.
template <int kAxis>
AxisRow spread(const AxisRow& a) {
  return {__builtin_shufflevector(a.at, a.at, kAxis, kAxis, kAxis, kAxis)};
}
// Returns (y, z, x).
inline AxisRow nextAxes(const AxisRow& a) {
  return {__builtin_shufflevector(a.at, a.at, 1, 2, 0, 3)};
}
inline AxisRow rowOf(const double* xyz) { return AxisRow{{xyz[0], xyz[1], xyz[2], 0}}; }
inline double sum(const AxisRow& a) { return a.at[0] + a.at[1] + a.at[2]; }
inline double dot(const AxisRow& a, const AxisRow& b) { return sum(a * b); }
inline AxisRow cross(const AxisRow& a, const AxisRow& b) {
  return nextAxes(a * nextAxes(b) - nextAxes(a) * b);
}

inline AxisMatrix transposed(const AxisMatrix& m) {
  const auto &x = m.column[0].at, &y = m.column[1].at, &z = m.column[2].at;
  const auto even = __builtin_shufflevector(x, y, 0, 4, 2, 6);
  const auto odd = __builtin_shufflevector(x, y, 1, 5, 3, 7);
  return {{{__builtin_shufflevector(even, z, 0, 1, 4, 7)},
           {__builtin_shufflevector(odd, z, 0, 1, 5, 7)},
           {__builtin_shufflevector(even, z, 2, 3, 6, 7)}}};
}
inline AxisRow operator*(const AxisMatrix& m, const AxisRow& a) {
  return m.column[0] * spread<0>(a) + m.column[1] * spread<1>(a) + m.column[2] * spread<2>(a);
}
inline AxisMatrix operator*(const AxisMatrix& m, const AxisMatrix& n) {
  return {{m * n.column[0], m * n.column[1], m * n.column[2]}};
}
inline AxisMatrix operator+(const AxisMatrix& m, const AxisMatrix& n) {
  return {{m.column[0] + n.column[0], m.column[1] + n.column[1], m.column[2] + n.column[2]}};
}
inline AxisMatrix operator*(double s, const AxisMatrix& m) {
  return {{s * m.column[0], s * m.column[1], s * m.column[2]}};
}
// Returns m - a b^T.
inline AxisMatrix lessProduct(const AxisMatrix& m, const AxisRow& a, const AxisRow& b) {
  return {{m.column[0] - a * spread<0>(b), m.column[1] - a * spread<1>(b),
           m.column[2] - a * spread<2>(b)}};
}
// Returns [t]x m.
inline AxisMatrix crossColumns(const AxisRow& t, const AxisMatrix& m) {
  return {{cross(t, m.column[0]), cross(t, m.column[1]), cross(t, m.column[2])}};
}

inline AxisPair operator+(const AxisPair& a, const AxisPair& b) {
  return {a.angular + b.angular, a.linear + b.linear};
}
inline AxisPair operator-(const AxisPair& a, const AxisPair& b) {
  return {a.angular - b.angular, a.linear - b.linear};
}
inline AxisPair operator*(double s, const AxisPair& a) { return {s * a.angular, s * a.linear}; }
inline double dot(const AxisPair& a, const AxisPair& b) {
  return sum(a.angular * b.angular + a.linear * b.linear);
}

// Returns I x.
inline AxisPair times(const InertiaBlocks& I, const AxisMatrix& coupling_transposed,
                      const AxisPair& x) {
  return {I.rotation * x.angular + I.coupling * x.linear,
          coupling_transposed * x.angular + I.translation * x.linear};
}
// Returns K x.
inline AxisPair times(const LinkState& link, const AxisPair& x) {
  return times(link.inertia, link.coupling_transposed, x);
}

// Brings a twist from the frame of a link's parent to the link's frame, X x of docs/theory.md eq.
// (76); and a wrench back, X^T f.
inline AxisPair toLink(const LinkState& link, const AxisPair& x) {
  return {link.offset_transposed * x.angular,
          link.offset_transposed * (x.linear + cross(x.angular, link.translation))};
}
inline AxisPair toParent(const LinkState& link, const AxisPair& f) {
  const AxisRow force = link.offset * f.linear;
  return {link.offset * f.angular + cross(link.translation, force), force};
}

// Rotates the first six coordinates into the base's frame; and back into W.
inline AxisPair ofBase(const LinkState& base, const double* u) {
  return {base.rotation_W_transposed * rowOf(u), base.rotation_W_transposed * rowOf(u + 3)};
}
inline void putInWorld(const LinkState& base, const AxisPair& a, double* u) {
  const AxisRow angular = base.rotation_W * a.angular, linear = base.rotation_W * a.linear;
  for (int i = 0; i < 3; ++i) {
    u[i] = angular.at[i];
    u[3 + i] = linear.at[i];
  }
}

// Returns S q' of the link's joint.
inline AxisPair alongAxes(const LinkState& link, const double* velocity) {
  AxisPair x{};
  for (int i = 0; i < link.axis_count; ++i) x = x + velocity[i] * link.axis[i];
  return x;
}

// Returns V x S q' of eq. (76), the acceleration of a link by the rotation of its axes.
AxisPair crossTwist(const AxisPair& V, const AxisPair& s) {
  return {cross(V.angular, s.angular), cross(V.linear, s.angular) + cross(V.angular, s.linear)};
}

void computePoses(LinkState* links, int count) noexcept {
  for (int l = 0; l < count; ++l) {
    LinkState& link = links[l];
    AxisMatrix R = link.offset;
    AxisRow position = link.translation;
    if (l > 0) {
      const LinkState& parent = links[link.parent];
      R = parent.rotation_W * R;
      position = parent.position_W + parent.rotation_W * position;
    }
    const AxisMatrix to_link = transposed(R);
    link.rotation_W = R;
    link.rotation_W_transposed = to_link;
    link.position_W = position;
    link.flow = to_link * link.flow_W;
    const AxisRow buoyancy = to_link * link.buoyancy_W;
    link.external = {to_link * link.applied_W.angular + cross(link.centre_of_volume, buoyancy),
                     to_link * link.applied_W.linear + buoyancy};
    if (link.accelerates_flow)
      link.external = link.external + times(link, {AxisRow{}, to_link * link.flow_acceleration_W});
  }
}

void setVelocity(LinkState* links, int count, const double* u) noexcept {
  links[0].twist = ofBase(links[0], u);
  for (int l = 1; l < count; ++l) {
    LinkState& link = links[l];
    link.twist = toLink(link, links[link.parent].twist) + alongAxes(link, u + link.first);
  }
}

// Returns the wrench of surroundings, buoyancy and damping on a link with twist V, in its frame.
AxisPair appliedOn(const LinkState& link, const MultiBodySettings& settings, const AxisPair& V) {
  AxisPair f = link.external;
  if (settings.linear_damping != 0 || settings.angular_damping != 0) {
    const double linear =
        settings.linear_damping * (1 + __builtin_sqrt(dot(V.linear, V.linear))) * link.mass;
    const double angular =
        settings.angular_damping * (1 + __builtin_sqrt(dot(V.angular, V.angular)));
    f = f - AxisPair{angular * (link.moments * V.angular), linear * V.linear};
  }
  if (!settings.has_gyroscopic_term)
    f.angular = f.angular + cross(V.angular, link.moments * V.angular);
  return f;
}

// Returns f_l of eq. (77): the wrench that the link needs besides the one that acts on it.
AxisPair forceOn(const LinkState& link, const MultiBodySettings& settings, const AxisPair& V,
                 const AxisPair& A) {
  const AxisPair V_r{V.angular, V.linear - link.flow};
  const AxisPair A_r{A.angular, A.linear + cross(V.angular, link.flow)};
  const AxisPair m = times(link, V_r);
  const AxisPair gyroscopic{cross(m.angular, V_r.angular) + cross(m.linear, V_r.linear),
                            cross(m.linear, V_r.angular)};
  return times(link, A_r) - gyroscopic - appliedOn(link, settings, V);
}

void computeForces(LinkState* links, int count, const MultiBodySettings& settings, const double* u,
                   const double* acceleration) noexcept {
  for (int l = 0; l < count; ++l) {
    LinkState& link = links[l];
    AxisPair V, A{};
    if (l == 0) {
      V = ofBase(link, u);
      if (!link.is_kept) A.linear = cross(V.linear, V.angular);
      if (acceleration) A = A + ofBase(link, acceleration);
    } else {
      const LinkState& parent = links[link.parent];
      const AxisPair relative = alongAxes(link, u + link.first);
      V = toLink(link, parent.twist) + relative;
      A = toLink(link, parent.acceleration) + crossTwist(V, relative);
      if (acceleration) A = A + alongAxes(link, acceleration + link.first);
    }
    link.twist = V;
    link.acceleration = A;
    link.force = forceOn(link, settings, V, A);
  }
}

void computeApplied(LinkState* links, int count, const MultiBodySettings& settings) noexcept {
  for (int l = 0; l < count; ++l) links[l].force = appliedOn(links[l], settings, links[l].twist);
}

void computeMomenta(LinkState* links, int count) noexcept {
  for (int l = 0; l < count; ++l) links[l].force = times(links[l], links[l].twist);
}

void measure(LinkState* links, int count) noexcept {
  for (int l = 0; l < count; ++l) {
    LinkState& link = links[l];
    const AxisPair V_r{link.twist.angular, link.twist.linear - link.flow};
    const AxisPair m = times(link, V_r);
    link.force = m;
    link.energy = dot(m, V_r);
  }
}

double norm(const LinkState* links, int count) noexcept {
  double sum = 0;
  for (int l = 0; l < count; ++l) sum += dot(times(links[l], links[l].twist), links[l].twist);
  return sum;
}

// Adds a wrench in the link's frame to that of its parent.
void addToParent(LinkState* links, const LinkState& link, const AxisPair& f) {
  AxisPair& of_parent = links[link.parent].force;
  of_parent = of_parent + toParent(link, f);
}

void sumForces(LinkState* links, int count, double* force) noexcept {
  for (int l = count - 1; l > 0; --l) {
    const LinkState& link = links[l];
    for (int i = 0; i < link.axis_count; ++i) force[link.first + i] = dot(link.force, link.axis[i]);
    addToParent(links, link, link.force);
  }
  putInWorld(links[0], links[0].force, force);
}

// Adds an inertia in the link's frame to the articulated inertia of its parent, docs/theory.md eq.
// (4) and (5).
void addToParent(LinkState* links, const LinkState& link, const InertiaBlocks& I) {
  const AxisMatrix &R = link.offset, &R_transposed = link.offset_transposed;
  const AxisRow& t = link.translation;
  const AxisMatrix M = R * I.translation * R_transposed;
  const AxisMatrix C = R * I.coupling * R_transposed;
  const AxisMatrix C_parent = C + crossColumns(t, M);
  // A - C [t] + [t] C_parent^T
  const AxisMatrix A = R * I.rotation * R_transposed + transposed(crossColumns(t, transposed(C))) +
                       crossColumns(t, transposed(C_parent));
  InertiaBlocks& of_parent = links[link.parent].articulated;
  of_parent = {of_parent.rotation + A, of_parent.coupling + C_parent, of_parent.translation + M};
}

// Inverts a symmetric matrix of `n` rows. Returns false if it is not positive definite.
bool invert(const double (&D)[3][3], int n, double (&inverse)[3][3]) {
  double lower[3][3] = {}, inverse_pivot[3] = {};
  bool is_positive = true;
  for (int i = 0; i < n; ++i) {
    double scaled[3] = {}, pivot = D[i][i];
    for (int j = 0; j < i; ++j) {
      scaled[j] = D[i][j];
      for (int k = 0; k < j; ++k) scaled[j] -= scaled[k] * lower[j][k];
      lower[i][j] = scaled[j] * inverse_pivot[j];
      pivot -= scaled[j] * lower[i][j];
    }
    inverse_pivot[i] = 1 / pivot;
    is_positive = is_positive && pivot > 0 && inverse_pivot[i] <= __DBL_MAX__;
  }
  for (int j = 0; j < n; ++j) {
    double x[3] = {0, 0, 0};
    x[j] = 1;
    for (int i = j + 1; i < n; ++i)
      for (int k = j; k < i; ++k) x[i] -= lower[i][k] * x[k];
    for (int i = n - 1; i >= 0; --i) {
      x[i] *= inverse_pivot[i];
      for (int k = i + 1; k < n; ++k) x[i] -= lower[k][i] * x[k];
      inverse[i][j] = x[i];
    }
  }
  return is_positive;
}

// Replaces I by I - I S (S^T I S)^-1 S^T I, eq. (79): inertia of the subtree that the parent feels.
// Returns false if S^T I S is not positive definite.
bool removeJoint(LinkState& link, InertiaBlocks& I) {
  if (link.axis_count == 0) return true;
  const AxisMatrix coupling_transposed = transposed(I.coupling);
  double D[3][3] = {};
  for (int i = 0; i < link.axis_count; ++i) {
    link.axis_momentum[i] = times(I, coupling_transposed, link.axis[i]);
    for (int j = 0; j <= i; ++j) D[i][j] = D[j][i] = dot(link.axis_momentum[i], link.axis[j]);
    link.weight[i] = D[i][i];
  }
  const bool is_positive = invert(D, link.axis_count, link.inverse);
  for (int i = 0; i < link.axis_count; ++i) {
    const AxisPair& axis_momentum = link.axis_momentum[i];
    AxisPair part = link.inverse[i][0] * link.axis_momentum[0];
    for (int j = 1; j < link.axis_count; ++j)
      part = part + link.inverse[i][j] * link.axis_momentum[j];
    I.rotation = lessProduct(I.rotation, axis_momentum.angular, part.angular);
    I.coupling = lessProduct(I.coupling, axis_momentum.angular, part.linear);
    I.translation = lessProduct(I.translation, axis_momentum.linear, part.linear);
  }
  return is_positive;
}

bool articulate(LinkState* links, int count, const KickTerms* kick) noexcept {
  for (int l = 0; l < count; ++l) {
    const InertiaBlocks& K = links[l].inertia;
    InertiaBlocks& M = links[l].articulated;
    M = K;
    if (!kick) continue;
    const double s = 1 + kick->drags[l], h = kick->h;
    M = {s * K.rotation, s * K.coupling, s * K.translation};
    if (!kick->resistance) continue;
    const InertiaBlocks& C = kick->resistance[l];
    M = {M.rotation + h * C.rotation, M.coupling + h * C.coupling,
         M.translation + h * C.translation};
  }
  bool is_positive = true;
  for (int l = count - 1; l > 0; --l) {
    LinkState& link = links[l];
    if (link.is_kept) continue;
    InertiaBlocks I = link.articulated;
    is_positive = removeJoint(link, I) && is_positive;
    if (!links[link.parent].is_kept) addToParent(links, link, I);
  }
  return is_positive;
}

void lockJoints(LinkState* links, int count) noexcept {
  for (int l = 0; l < count; ++l) links[l].articulated = links[l].inertia;
  for (int l = count - 1; l > 0; --l) addToParent(links, links[l], links[l].articulated);
}

// Returns component `axis` of (S^T I^A S)^-1 `rest`.
double answerOf(const LinkState& link, int axis) {
  double q = 0;
  for (int j = 0; j < link.axis_count; ++j) q += link.inverse[axis][j] * link.rest[j];
  return q;
}

void sumNeeds(LinkState* links, int count) noexcept {
  for (int l = count - 1; l > 0; --l) {
    LinkState& link = links[l];
    if (link.is_kept) continue;
    AxisPair f = link.force;
    for (int i = 0; i < link.axis_count; ++i) link.rest[i] -= dot(f, link.axis[i]);
    for (int i = 0; i < link.axis_count; ++i) f = f + answerOf(link, i) * link.axis_momentum[i];
    addToParent(links, link, f);
  }
}

void accelerate(LinkState* links, int count, double* result) noexcept {
  putInWorld(links[0], links[0].acceleration, result);
  for (int l = 1; l < count; ++l) {
    LinkState& link = links[l];
    AxisPair a = toLink(link, links[link.parent].acceleration);
    for (int i = 0; i < link.axis_count; ++i) link.rest[i] -= dot(link.axis_momentum[i], a);
    for (int i = 0; i < link.axis_count; ++i) {
      const double q = link.is_kept ? 0 : answerOf(link, i);
      result[link.first + i] = q;
      a = a + q * link.axis[i];
    }
    link.acceleration = a;
  }
}

}  // namespace

const LinkKernel AMBIENT_KERNEL(kLinkKernel){
    computePoses, setVelocity, computeForces, computeApplied, computeMomenta, measure,
    norm,         sumForces,   articulate,    lockJoints,     sumNeeds,       accelerate};

}  // namespace ambient
