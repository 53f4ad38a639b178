#include "bullet_ambient/motion/links/link_tree.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/spatial/rotation.h"

namespace ambient {

namespace {

// Returns the rotation by an angle [rad] about a unit axis.
Matrix3 rotationAbout(const Vector3& axis, double angle) {
  const auto [s, c] = portable::sineAndCosine(angle);
  const Vector3 n = s * axis, m = (1 - c) * axis;
  const double xy = m.x() * axis.y(), xz = m.x() * axis.z(), yz = m.y() * axis.z();
  Matrix3 R;
  R(0, 0) = c + m.x() * axis.x();
  R(1, 1) = c + m.y() * axis.y();
  R(2, 2) = c + m.z() * axis.z();
  R(0, 1) = xy - n.z();
  R(1, 0) = xy + n.z();
  R(0, 2) = xz + n.y();
  R(2, 0) = xz - n.y();
  R(1, 2) = yz - n.x();
  R(2, 1) = yz + n.x();
  return R;
}

Quaternion quaternionOf(const JointPosition& p) { return Quaternion(p[3], p[0], p[1], p[2]); }
JointPosition positionOf(const Quaternion& q) { return {q.x(), q.y(), q.z(), q.w()}; }
Vector3 jointVector(const double* x) { return {x[0], x[1], x[2]}; }

// Coordinates of a planar joint: rotation axis; displacement as a vector from its components along
// the two axes of the plane; and one component of a displacement.
Vector3 planeNormal(const Joint& joint) { return joint.axes[0].head<3>(); }
Vector3 planeVector(const Joint& joint, const double* displacements) {
  return displacements[0] * joint.axes[1].tail<3>() + displacements[1] * joint.axes[2].tail<3>();
}
double displacementAlong(const Joint& joint, int axis, const Vector3& displacement) {
  const Vector3 b = joint.axes[axis].tail<3>();
  return b.dot(displacement) / b.squaredNorm();
}

// Moves a planar joint along an arc of constant velocity in the link's axes.
JointPosition movedInPlane(const Joint& joint, const JointPosition& position,
                           const double* velocity, double h) {
  const double half_turn = 0.5 * h * velocity[0];
  // Length of the chord over that of the arc. For small angles by its series, because the quotient
  // loses digits there.
  const double chord = std::abs(half_turn) < 1e-4 ? 1 - half_turn * half_turn / 6
                                                  : portable::sin(half_turn) / half_turn;
  const Vector3 displacement = rotationAbout(planeNormal(joint), position[0] + half_turn) *
                               (chord * h * planeVector(joint, velocity + 1));
  return {position[0] + 2 * half_turn, position[1] + displacementAlong(joint, 1, displacement),
          position[2] + displacementAlong(joint, 2, displacement), 0};
}

// Computes velocityBetween() for a planar joint.
void velocityInPlane(const Joint& joint, const JointPosition& from, const JointPosition& to,
                     double h, double* velocity) {
  const double displacements[2] = {(to[1] - from[1]) / h, (to[2] - from[2]) / h};
  const Vector3 v = rotationAbout(planeNormal(joint), -to[0]) * planeVector(joint, displacements);
  velocity[0] = (to[0] - from[0]) / h;
  for (int axis : {1, 2}) {
    velocity[axis] = displacementAlong(joint, axis, v) / joint.axes[axis].tail<3>().squaredNorm();
  }
}

}  // namespace

double jointSpin(const Joint& joint, const double* velocity) noexcept {
  switch (joint.kind) {
    case JointKind::kRevolute:
    case JointKind::kPlanar:
      return std::abs(velocity[0]);
    case JointKind::kSpherical:
      return portable::hypot(velocity[0], velocity[1], velocity[2]);
    default:
      return 0;
  }
}

FrameOffset linkOffset(const Joint& joint, const JointPosition& position) noexcept {
  const Matrix3& from_zero = joint.zero_axes;
  FrameOffset offset{from_zero, joint.parent_to_pivot};
  switch (joint.kind) {
    case JointKind::kFixed:
      break;
    case JointKind::kRevolute:
      offset.rotation = from_zero * rotationAbout(planeNormal(joint), position[0]);
      break;
    case JointKind::kPrismatic:
      offset.translation += from_zero * (position[0] * joint.axes[0].tail<3>());
      break;
    case JointKind::kSpherical:
      offset.rotation = from_zero * quaternionOf(position).toRotationMatrix();
      break;
    case JointKind::kPlanar:
      offset.rotation = from_zero * rotationAbout(planeNormal(joint), position[0]);
      offset.translation += from_zero * planeVector(joint, position.data() + 1);
      break;
  }
  offset.translation += offset.rotation * joint.pivot_to_link;
  return offset;
}

JointPosition moved(const Joint& joint, const JointPosition& position, const double* velocity,
                    double h) noexcept {
  switch (joint.kind) {
    case JointKind::kFixed:
      return position;
    case JointKind::kRevolute:
    case JointKind::kPrismatic:
      return {position[0] + h * velocity[0], 0, 0, 0};
    case JointKind::kSpherical: {
      const Quaternion turn = rotationFromVector(h * jointVector(velocity));
      return positionOf((quaternionOf(position) * turn).normalized());
    }
    case JointKind::kPlanar:
      return movedInPlane(joint, position, velocity, h);
  }
  return position;
}

void velocityBetween(const Joint& joint, const JointPosition& from, const JointPosition& to,
                     double h, double* velocity) noexcept {
  AMBIENT_ASSERT(h > 0);
  switch (joint.kind) {
    case JointKind::kFixed:
      return;
    case JointKind::kRevolute:
    case JointKind::kPrismatic:
      velocity[0] = (to[0] - from[0]) / h;
      return;
    case JointKind::kSpherical: {
      const Vector3 turn = rotationVector(quaternionOf(from).conjugate() * quaternionOf(to)) / h;
      for (int i = 0; i < 3; ++i) velocity[i] = turn[i];
      return;
    }
    case JointKind::kPlanar:
      velocityInPlane(joint, from, to, h, velocity);
  }
}

namespace {

[[noreturn]] void rejectLink(int link, const char* quantity, double value, const char* limit) {
  throw std::invalid_argument("link " + std::to_string(link) + ": " + quantity + " is " +
                              std::to_string(value) + ", must be " + limit);
}

}  // namespace

int coordinateCount(const LinkTree& tree) {
  int count = 6;
  for (int l = 1; l < tree.size(); ++l) count += axisCount(tree.links[l].joint.kind);
  return count;
}

void checkTree(const LinkTree& tree) {
  if (tree.size() < 1) throw std::invalid_argument("a tree of links needs a base");
  for (int l = 0; l < tree.size(); ++l) {
    const Link& link = tree.links[l];
    if (l == 0 ? link.parent != -1 : !(link.parent >= 0 && link.parent < l)) {
      rejectLink(l, "its parent", link.parent, "a link before it, -1 for the base alone");
    }
    if (!(link.mass >= 0) || !std::isfinite(link.mass)) {
      rejectLink(l, "mass [kg]", link.mass, "zero or positive and finite");
    }
    for (const double moment : link.inertia) {
      if (!(moment >= 0) || !std::isfinite(moment)) {
        rejectLink(l, "moment of inertia [kg m^2]", moment, "zero or positive and finite");
      }
    }
  }
}

void movePose(const LinkTree& tree, const TreePose& from, const CoordinatesIn& u, double h,
              TreePose& to) noexcept {
  AMBIENT_ASSERT(from.joints.size() == to.joints.size());
  AMBIENT_ASSERT(static_cast<int>(to.joints.size()) == tree.size());
  if (tree.links[0].keeps_position) {
    to.orientation = from.orientation;
    to.position = from.position;
  } else {
    const Vector3 turn = h * u.head<3>(), displacement = h * u.segment<3>(3);
    to.orientation = (rotationFromVector(turn) * from.orientation).normalized();
    to.position = from.position + displacement;
  }
  int first = 6;
  for (int l = 1; l < tree.size(); ++l) {
    const Link& link = tree.links[l];
    to.joints[l] = link.keeps_position ? from.joints[l]
                                       : moved(link.joint, from.joints[l], u.data() + first, h);
    first += axisCount(link.joint.kind);
  }
}

void velocityBetween(const LinkTree& tree, const TreePose& from, const TreePose& to, double h,
                     CoordinatesOut u) noexcept {
  if (!tree.links[0].keeps_position) {
    u.head<3>() = rotationVector(to.orientation * from.orientation.conjugate()) / h;
    u.segment<3>(3) = (to.position - from.position) / h;
  }
  int first = 6;
  for (int l = 1; l < tree.size(); ++l) {
    const Link& link = tree.links[l];
    if (!link.keeps_position)
      velocityBetween(link.joint, from.joints[l], to.joints[l], h, u.data() + first);
    first += axisCount(link.joint.kind);
  }
}

bool turnsTooFastForBullet(const LinkTree& tree, const CoordinatesIn& u, double h) noexcept {
  AMBIENT_ASSERT(h > 0);
  const double limit = 0.25 * kPi / h;
  bool is_too_fast = u.head<3>().norm() > limit;
  int first = 6;
  for (int l = 1; l < tree.size(); ++l) {
    const JointKind kind = tree.links[l].joint.kind;
    if (kind == JointKind::kSpherical)
      is_too_fast = is_too_fast || u.segment<3>(first).norm() > limit;
    first += axisCount(kind);
  }
  return is_too_fast;
}

RestInFlow restInFlow(const LinkTree& tree) noexcept {
  const Vector3* flow = nullptr;
  bool is_one = true;
  for (const Link& link : tree.links) {
    if (!link.model) continue;
    if (!flow) flow = &link.surroundings.ambient_velocity;
    is_one = is_one && link.surroundings.ambient_velocity == *flow;
  }
  if (!flow) return {Vector3::Zero(), true};
  if (tree.links[0].keeps_velocity) return {Vector3::Zero(), is_one && flow->isZero(0)};
  return {*flow, is_one};
}

bool restInFlow(const LinkTree& tree, CoordinatesOut u) noexcept {
  const RestInFlow rest = restInFlow(tree);
  u.setZero();
  u.segment<3>(3) = rest.velocity;
  return rest.exists;
}

bool findFlow(const LinkTree& tree, const CoordinatesIn& u, Coordinates& flow) noexcept {
  if (!restInFlow(tree, flow)) return false;
  int first = 0;
  for (int l = 0; l < tree.size(); ++l) {
    const Link& link = tree.links[l];
    const int count = l == 0 ? 6 : axisCount(link.joint.kind);
    if (link.keeps_velocity && count > 0 && u.segment(first, count).cwiseAbs().maxCoeff() > 0)
      return false;
    first += count;
  }
  return true;
}

}  // namespace ambient
