#include "tests/reference/jointed_bodies.h"

#include <Eigen/LU>

namespace ambient::reference {
namespace {

using V3 = JointedVector3;
using M3 = JointedMatrix3;
using M6 = JointedMatrix6;

M3 hat(const V3& a) {
  M3 m;
  m << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return m;
}

M6 inWorld(const M6& K, const M3& R) {
  M6 B = M6::Zero();
  B.topLeftCorner<3, 3>() = R;
  B.bottomRightCorner<3, 3>() = R;
  return B * K * B.transpose();
}

M6 dryInertia(const JointedBody& b) {
  M6 K = M6::Zero();
  K.diagonal() << b.moments, V3::Constant(b.mass);
  return K;
}

M6 totalInertia(const JointedBody& b) { return inWorld(dryInertia(b) + b.added_mass, b.rotation); }

// Applied forces less the velocity terms: w x (J w), dK/dt x with K in world axes, and the moment
// (v - flow) x p of the fluid's momentum p about the moving centre of mass.
JointedVector6 freeForce(const JointedBody& b) {
  JointedVector6 f = b.applied;
  const V3 buoyancy = -b.displaced_mass * (b.gravity - b.flow_acceleration);
  f.head<3>() += (b.rotation * b.centre_of_volume).cross(buoyancy);
  f.tail<3>() += buoyancy;
  const M3 J = b.rotation * b.moments.asDiagonal() * b.rotation.transpose();
  f.head<3>() -= b.w.cross(J * b.w);
  const M6 K = inWorld(b.added_mass, b.rotation);
  M6 turn = M6::Zero();
  turn.topLeftCorner<3, 3>() = turn.bottomRightCorner<3, 3>() = hat(b.w);
  const M6 rate = turn * K - K * turn;
  JointedVector6 x, a;
  x << b.w, b.v - b.flow;
  a << V3::Zero(), b.flow_acceleration;
  const JointedVector6 momentum = K * x;
  f += K * a - rate * x;
  f.head<3>() -= (b.v - b.flow).cross(V3(momentum.tail<3>()));
  return f;
}

// One constraint between a body and its parent: jacobians and velocity-dependent acceleration.
struct Row {
  JointedVector6 parent, child;
  JointedReal bias;  // J' u
};

// Row of d . (w_b - w_a); the direction d turns with `carrier_spin`.
Row spinRow(const V3& d, const V3& carrier_spin, const JointedBody& a, const JointedBody& b) {
  Row row;
  row.child << d, V3::Zero();
  row.parent = -row.child;
  row.bias = carrier_spin.cross(d).dot(b.w - a.w);
  return row;
}

// Row of d . (velocity of b's centre as seen from a); the direction d turns with `carrier_spin`.
Row slideRow(const V3& d, const V3& carrier_spin, const JointedBody& a, const JointedBody& b) {
  const V3 s = b.origin - a.origin, rate = b.v - a.v;
  Row row;
  row.child << V3::Zero(), d;
  row.parent << -s.cross(d), -d;
  row.bias = carrier_spin.cross(d).dot(rate - a.w.cross(s)) - d.dot(a.w.cross(rate));
  return row;
}

// Row of d . (velocity of the pivot as part of b less the one as part of a), d fixed in the world.
Row pivotRow(const V3& d, const JointedBody& a, const JointedBody& b) {
  const V3 r_b = -(b.rotation * b.pivot_to_body), r_a = b.origin + r_b - a.origin;
  Row row;
  row.child << r_b.cross(d), d;
  row.parent << -r_a.cross(d), -d;
  row.bias = d.dot(b.w.cross(b.w.cross(r_b)) - a.w.cross(a.w.cross(r_a)));
  return row;
}

std::array<V3, 2> across(const V3& n) {
  const V3 first = n.unitOrthogonal();
  return {first, n.cross(first)};
}

std::vector<Row> constraintRows(const JointedBody& a, const JointedBody& b) {
  std::vector<Row> rows;
  const auto axis = [&](int i) -> V3 { return b.rotation * b.axes[i]; };
  const auto noSpin = [&](const V3& d) { rows.push_back(spinRow(d, a.w, a, b)); };
  const auto noSlide = [&](const V3& d) { rows.push_back(slideRow(d, a.w, a, b)); };
  const bool has_pivot = b.kind != JointedKind::kPrismatic && b.kind != JointedKind::kPlanar;
  for (int i = 0; i < 3; ++i) {
    const V3 unit = V3::Unit(i);
    if (has_pivot) rows.push_back(pivotRow(unit, a, b));
    if (b.kind == JointedKind::kFixed || b.kind == JointedKind::kPrismatic) noSpin(unit);
  }
  if (b.kind == JointedKind::kRevolute || b.kind == JointedKind::kPlanar)
    for (const V3& d : across(axis(0))) noSpin(d);
  if (b.kind == JointedKind::kPrismatic)
    for (const V3& d : across(axis(0))) noSlide(d);
  if (b.kind == JointedKind::kPlanar) noSlide(axis(0));
  return rows;
}

// Returns rows of the joint's free directions: J u is a velocity of the joint.
std::vector<Row> freeRows(const JointedBody& a, const JointedBody& b) {
  std::vector<Row> rows;
  const auto axis = [&](int i) -> V3 { return b.rotation * b.axes[i]; };
  switch (b.kind) {
    case JointedKind::kFixed:
      break;
    case JointedKind::kRevolute:
      rows.push_back(spinRow(axis(0), b.w, a, b));
      break;
    case JointedKind::kPrismatic:
      rows.push_back(slideRow(axis(0), b.w, a, b));
      break;
    case JointedKind::kSpherical:
      for (int i = 0; i < 3; ++i) rows.push_back(spinRow(b.rotation * V3::Unit(i), b.w, a, b));
      break;
    case JointedKind::kPlanar:
      rows.push_back(spinRow(axis(0), b.w, a, b));
      for (int i : {1, 2}) rows.push_back(slideRow(axis(i) / b.axes[i].squaredNorm(), b.w, a, b));
      break;
  }
  return rows;
}

struct System {
  JointedMatrix matrix;  // [M, -J^T; J, 0]
  JointedVector bias;    // -J' u of the constraints
};

System makeSystem(const std::vector<JointedBody>& bodies, bool fixed) {
  std::vector<std::pair<int, Row>> rows;
  for (std::size_t i = 1; i < bodies.size(); ++i)
    for (const Row& row : constraintRows(bodies[bodies[i].parent], bodies[i]))
      rows.emplace_back(static_cast<int>(i), row);
  const int velocities = 6 * static_cast<int>(bodies.size());
  const int constraints = static_cast<int>(rows.size()) + (fixed ? 6 : 0);
  System system{JointedMatrix::Zero(velocities + constraints, velocities + constraints),
                JointedVector::Zero(constraints)};
  for (std::size_t i = 0; i < bodies.size(); ++i)
    system.matrix.block<6, 6>(6 * i, 6 * i) = totalInertia(bodies[i]);
  JointedMatrix J = JointedMatrix::Zero(constraints, velocities);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const auto& [child, row] = rows[k];
    J.block<1, 6>(k, 6 * child) = row.child.transpose();
    J.block<1, 6>(k, 6 * bodies[child].parent) = row.parent.transpose();
    system.bias[k] = -row.bias;
  }
  if (fixed) {
    J.bottomLeftCorner<6, 6>().setIdentity();
    system.bias.tail<3>() = bodies[0].w.cross(bodies[0].v);
  }
  system.matrix.topRightCorner(velocities, constraints) = -J.transpose();
  system.matrix.bottomLeftCorner(constraints, velocities) = J;
  return system;
}

// Stacks the base's change, then the changes along the free directions of all joints.
JointedVector alongJoints(const std::vector<JointedBody>& bodies, const JointedVector& change,
                          bool with_bias) {
  std::vector<JointedReal> values(change.data(), change.data() + 6);
  for (std::size_t i = 1; i < bodies.size(); ++i) {
    const int parent = bodies[i].parent;
    for (const Row& row : freeRows(bodies[parent], bodies[i]))
      values.push_back(row.child.dot(change.segment<6>(6 * i)) +
                       row.parent.dot(change.segment<6>(6 * parent)) + (with_bias ? row.bias : 0));
  }
  return Eigen::Map<JointedVector>(values.data(), static_cast<Eigen::Index>(values.size()));
}

M3 positionRotation(const JointedBody& b) {
  const auto& q = b.position;
  if (b.kind == JointedKind::kSpherical)
    return Eigen::Quaternion<JointedReal>(q[3], q[0], q[1], q[2]).toRotationMatrix();
  if (b.kind == JointedKind::kRevolute || b.kind == JointedKind::kPlanar)
    return Eigen::AngleAxis<JointedReal>(q[0], b.axes[0]).toRotationMatrix();
  return M3::Identity();
}

}  // namespace

void placeBodies(std::vector<JointedBody>& bodies) {
  for (std::size_t i = 1; i < bodies.size(); ++i) {
    JointedBody& b = bodies[i];
    const JointedBody& a = bodies[b.parent];
    const M3 zero = a.rotation * b.zero_rotation.transpose();  // axes at position 0, world
    b.rotation = zero * positionRotation(b);
    const auto& q = b.position;
    const auto& s = b.velocity;
    V3 slide = V3::Zero(), slide_rate = V3::Zero(), spin = V3::Zero();
    if (b.kind == JointedKind::kPrismatic) {
      slide = zero * b.axes[0] * q[0];
      slide_rate = zero * b.axes[0] * s[0];
    }
    if (b.kind == JointedKind::kPlanar) {
      slide = zero * (b.axes[1] * q[1] + b.axes[2] * q[2]);
      slide_rate = b.rotation * (b.axes[1] * s[1] + b.axes[2] * s[2]);
    }
    if (b.kind == JointedKind::kRevolute || b.kind == JointedKind::kPlanar)
      spin = b.rotation * b.axes[0] * s[0];
    if (b.kind == JointedKind::kSpherical) spin = b.rotation * V3(s[0], s[1], s[2]);
    const V3 pivot = a.origin + a.rotation * b.parent_to_pivot + slide;
    b.origin = pivot + b.rotation * b.pivot_to_body;
    b.w = a.w + spin;
    b.v = a.v + a.w.cross(pivot - a.origin) + slide_rate + b.w.cross(b.origin - pivot);
  }
}

JointedVector jointedAccelerations(const std::vector<JointedBody>& bodies, bool fixed) {
  const System system = makeSystem(bodies, fixed);
  JointedVector right(system.matrix.rows());
  for (std::size_t i = 0; i < bodies.size(); ++i) right.segment<6>(6 * i) = freeForce(bodies[i]);
  // Joint forces act on both bodies with opposite signs, like constraint reactions.
  for (std::size_t i = 1; i < bodies.size(); ++i) {
    const int parent = bodies[i].parent;
    const std::vector<Row> rows = freeRows(bodies[parent], bodies[i]);
    for (std::size_t k = 0; k < rows.size(); ++k) {
      right.segment<6>(6 * i) += bodies[i].force[k] * rows[k].child;
      right.segment<6>(6 * parent) += bodies[i].force[k] * rows[k].parent;
    }
  }
  right.tail(system.bias.size()) = system.bias;
  const JointedVector solution = system.matrix.fullPivLu().solve(right);
  return alongJoints(bodies, solution, true);
}

JointedVector jointedResponse(const std::vector<JointedBody>& bodies, bool fixed,
                              const JointedVector& impulse_of_bodies) {
  const System system = makeSystem(bodies, fixed);
  JointedVector right = JointedVector::Zero(system.matrix.rows());
  right.head(impulse_of_bodies.size()) = impulse_of_bodies;
  const JointedVector solution = system.matrix.fullPivLu().solve(right);
  return alongJoints(bodies, solution, false);
}

}  // namespace ambient::reference
