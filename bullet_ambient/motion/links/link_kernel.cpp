#include "bullet_ambient/motion/links/link_kernel.h"

#include "bullet_ambient/motion/links/axis_rows.h"

namespace ambient {
namespace {

// Returns V x S q' of eq. (76), the acceleration of a link by the rotation of its axes.
Spatial crossTwist(const Spatial& V, const Spatial& s) {
  return {cross(V.angular, s.angular), cross(V.linear, s.angular) + cross(V.angular, s.linear)};
}

void place(LinkState* links, int count) noexcept {
  for (int l = 0; l < count; ++l) {
    LinkState& link = links[l];
    Matrix R = load(link.offset);
    Row position = load(link.translation);
    if (l > 0) {
      const LinkState& parent = links[link.parent];
      const Matrix of_parent = load(parent.rotation_W);
      R = of_parent * R;
      position = load(parent.position_W) + of_parent * position;
    }
    const Matrix to_link = transposed(R);
    store(link.rotation_W, R);
    store(link.rotation_W_transposed, to_link);
    store(link.position_W, position);
    store(link.flow, to_link * load(link.flow_W));
    const Row buoyancy = to_link * load(link.buoyancy_W);
    Spatial external{
        to_link * load(link.applied_W.angular) + cross(load(link.centre_of_volume), buoyancy),
        to_link * load(link.applied_W.linear) + buoyancy};
    if (link.accelerates_flow)
      external = external + times(link, {zeroRow(), to_link * load(link.flow_acceleration_W)});
    store(link.external, external);
  }
}

void setVelocity(LinkState* links, int count, const double* u) noexcept {
  store(links[0].twist, ofBase(links[0], u));
  for (int l = 1; l < count; ++l) {
    LinkState& link = links[l];
    store(link.twist,
          toLink(link, load(links[link.parent].twist)) + alongAxes(link, u + link.first));
  }
}

// Returns the wrench of surroundings, buoyancy and damping on a link with twist V, in its frame.
Spatial appliedOn(const LinkState& link, const TreeHabits& habits, const Spatial& V) {
  Spatial f = load(link.external);
  if (habits.linear_damping != 0 || habits.angular_damping != 0) {
    const double linear =
        habits.linear_damping * (1 + __builtin_sqrt(dot(V.linear, V.linear))) * link.mass;
    const double angular = habits.angular_damping * (1 + __builtin_sqrt(dot(V.angular, V.angular)));
    f = f - Spatial{angular * (load(link.moments) * V.angular), linear * V.linear};
  }
  if (!habits.has_gyroscopic_term)
    f.angular = f.angular + cross(V.angular, load(link.moments) * V.angular);
  return f;
}

// Returns f_l of eq. (77): the wrench that the link needs besides the one that acts on it.
Spatial forceOn(const LinkState& link, const TreeHabits& habits, const Spatial& V,
                const Spatial& A) {
  const Row flow = load(link.flow);
  const Inertia K = load(link.inertia);
  const Matrix coupling_transposed = load(link.coupling_transposed);
  const Spatial V_r{V.angular, V.linear - flow};
  const Spatial A_r{A.angular, A.linear + cross(V.angular, flow)};
  const Spatial m = times(K, coupling_transposed, V_r);
  const Spatial gyroscopic{cross(m.angular, V_r.angular) + cross(m.linear, V_r.linear),
                           cross(m.linear, V_r.angular)};
  return times(K, coupling_transposed, A_r) - gyroscopic - appliedOn(link, habits, V);
}

void computeForces(LinkState* links, int count, const TreeHabits& habits, const double* u,
                   const double* acceleration) noexcept {
  for (int l = 0; l < count; ++l) {
    LinkState& link = links[l];
    Spatial V, A;
    if (l == 0) {
      V = ofBase(link, u);
      A = {zeroRow(), zeroRow()};
      if (!link.is_kept) A.linear = cross(V.linear, V.angular);
      if (acceleration) A = A + ofBase(link, acceleration);
    } else {
      const LinkState& parent = links[link.parent];
      const Spatial relative = alongAxes(link, u + link.first);
      V = toLink(link, load(parent.twist)) + relative;
      A = toLink(link, load(parent.acceleration)) + crossTwist(V, relative);
      if (acceleration) A = A + alongAxes(link, acceleration + link.first);
    }
    store(link.twist, V);
    store(link.acceleration, A);
    store(link.force, forceOn(link, habits, V, A));
  }
}

void computeApplied(LinkState* links, int count, const TreeHabits& habits) noexcept {
  for (int l = 0; l < count; ++l)
    store(links[l].force, appliedOn(links[l], habits, load(links[l].twist)));
}

void computeMomenta(LinkState* links, int count) noexcept {
  for (int l = 0; l < count; ++l) store(links[l].force, times(links[l], load(links[l].twist)));
}

void measure(LinkState* links, int count) noexcept {
  for (int l = 0; l < count; ++l) {
    LinkState& link = links[l];
    const Spatial V_r{load(link.twist.angular), load(link.twist.linear) - load(link.flow)};
    const Spatial m = times(link, V_r);
    store(link.force, m);
    link.energy = dot(m, V_r);
  }
}

double norm(const LinkState* links, int count) noexcept {
  double sum = 0;
  for (int l = 0; l < count; ++l) {
    const Spatial V = load(links[l].twist);
    sum += dot(times(links[l], V), V);
  }
  return sum;
}

void sumForces(LinkState* links, int count, double* force) noexcept {
  for (int l = count - 1; l > 0; --l) {
    const LinkState& link = links[l];
    const Spatial f = load(link.force);
    for (int i = 0; i < link.axis_count; ++i) force[link.first + i] = dot(f, load(link.axis[i]));
    AxisPair& of_parent = links[link.parent].force;
    store(of_parent, load(of_parent) + toParent(link, f));
  }
  putInWorld(links[0], load(links[0].force), force);
}

// Adds an inertia in the link's frame to the articulated inertia of its parent.
void addToParent(LinkState* links, const LinkState& link, const Inertia& I) {
  InertiaBlocks& of_parent = links[link.parent].articulated;
  const Inertia added = toParent(link, I), before = load(of_parent);
  store(of_parent, {before.rotation + added.rotation, before.coupling + added.coupling,
                    before.translation + added.translation});
}

// Replaces I by I - I S (S^T I S)^-1 S^T I, eq. (79): inertia of the subtree that the parent feels.
// Returns false if S^T I S is not positive definite.
bool takeOutJoint(LinkState& link, Inertia& I) {
  if (link.axis_count == 0) return true;
  const Matrix coupling_transposed = transposed(I.coupling);
  Spatial push[3];
  double D[3][3] = {};
  for (int i = 0; i < link.axis_count; ++i) {
    push[i] = times(I, coupling_transposed, load(link.axis[i]));
    store(link.push[i], push[i]);
    for (int j = 0; j <= i; ++j) D[i][j] = D[j][i] = dot(push[i], load(link.axis[j]));
    link.weight[i] = D[i][i];
  }
  const bool is_positive = invert(D, link.axis_count, link.inverse);
  for (int i = 0; i < link.axis_count; ++i) {
    Spatial part = link.inverse[i][0] * push[0];
    for (int j = 1; j < link.axis_count; ++j) part = part + link.inverse[i][j] * push[j];
    I.rotation = lessProduct(I.rotation, push[i].angular, part.angular);
    I.coupling = lessProduct(I.coupling, push[i].angular, part.linear);
    I.translation = lessProduct(I.translation, push[i].linear, part.linear);
  }
  return is_positive;
}

bool articulate(LinkState* links, int count, const double* drag, BaseFactor& base) noexcept {
  for (int l = 0; l < count; ++l) {
    links[l].articulated = links[l].inertia;
    if (!drag) continue;
    const Inertia K = load(links[l].inertia);
    const double s = 1 + drag[l];
    store(links[l].articulated, {s * K.rotation, s * K.coupling, s * K.translation});
  }
  bool is_positive = true;
  for (int l = count - 1; l > 0; --l) {
    LinkState& link = links[l];
    if (link.is_kept) continue;
    Inertia I = load(link.articulated);
    is_positive = takeOutJoint(link, I) && is_positive;
    if (!links[link.parent].is_kept) addToParent(links, link, I);
  }
  if (links[0].is_kept) return is_positive;
  factorBase(links[0].articulated, base);
  return is_positive && base.is_positive;
}

void holdJoints(LinkState* links, int count, BaseFactor& held) noexcept {
  for (int l = 0; l < count; ++l) links[l].articulated = links[l].inertia;
  for (int l = count - 1; l > 0; --l) addToParent(links, links[l], load(links[l].articulated));
  factorBase(links[0].articulated, held);
}

// Solves for the acceleration of the base.
void solveBase(LinkState& base, const BaseFactor& factor, double* result) {
  double a[6] = {0, 0, 0, 0, 0, 0};
  if (!base.is_kept) {
    for (int i = 0; i < 3; ++i) {
      a[i] = -base.force.angular.at[i];
      a[3 + i] = -base.force.linear.at[i];
    }
    answer(factor, a);
  }
  const Spatial acceleration{rowOf(a), rowOf(a + 3)};
  store(base.acceleration, acceleration);
  putInWorld(base, acceleration, result);
}

void solve(LinkState* links, int count, const BaseFactor& base, double* result) noexcept {
  for (int l = count - 1; l > 0; --l) {
    LinkState& link = links[l];
    if (link.is_kept) continue;
    Spatial f = load(link.force);
    for (int i = 0; i < link.axis_count; ++i) link.rest[i] -= dot(f, load(link.axis[i]));
    for (int i = 0; i < link.axis_count; ++i) {
      double q = 0;
      for (int j = 0; j < link.axis_count; ++j) q += link.inverse[i][j] * link.rest[j];
      f = f + q * load(link.push[i]);
    }
    AxisPair& of_parent = links[link.parent].force;
    store(of_parent, load(of_parent) + toParent(link, f));
  }
  solveBase(links[0], base, result);
  for (int l = 1; l < count; ++l) {
    LinkState& link = links[l];
    Spatial a = toLink(link, load(links[link.parent].acceleration));
    for (int i = 0; i < link.axis_count; ++i) link.rest[i] -= dot(load(link.push[i]), a);
    for (int i = 0; i < link.axis_count; ++i) {
      double q = 0;
      if (!link.is_kept)
        for (int j = 0; j < link.axis_count; ++j) q += link.inverse[i][j] * link.rest[j];
      result[link.first + i] = q;
      a = a + q * load(link.axis[i]);
    }
    store(link.acceleration, a);
  }
}

}  // namespace

const LinkKernel AMBIENT_KERNEL(kLinkKernel){
    place, setVelocity, computeForces, computeApplied, computeMomenta, measure,
    norm,  sumForces,   articulate,    holdJoints,     solve,          answer};

}  // namespace ambient
