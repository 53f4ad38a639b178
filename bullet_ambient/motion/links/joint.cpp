#include "bullet_ambient/motion/links/joint.h"

#include <cmath>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/elementary.h"
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
Vector3 planeVector(const Joint& joint, const double* ways) {
  return ways[0] * joint.axes[1].tail<3>() + ways[1] * joint.axes[2].tail<3>();
}
double wayAlong(const Joint& joint, int axis, const Vector3& way) {
  const Vector3 b = joint.axes[axis].tail<3>();
  return b.dot(way) / b.squaredNorm();
}

// Moves a planar joint along an arc of constant velocity in the link's axes.
JointPosition movedInPlane(const Joint& joint, const JointPosition& position,
                           const double* velocity, double h) {
  const double half_turn = 0.5 * h * velocity[0];
  // Length of the chord over that of the arc. For small angles by its series, because the quotient
  // loses digits there.
  const double chord = std::abs(half_turn) < 1e-4 ? 1 - half_turn * half_turn / 6
                                                  : portable::sin(half_turn) / half_turn;
  const Vector3 way = rotationAbout(planeNormal(joint), position[0] + half_turn) *
                      (chord * h * planeVector(joint, velocity + 1));
  return {position[0] + 2 * half_turn, position[1] + wayAlong(joint, 1, way),
          position[2] + wayAlong(joint, 2, way), 0};
}

// Computes velocityBetween() for a planar joint.
void velocityInPlane(const Joint& joint, const JointPosition& from, const JointPosition& to,
                     double h, double* velocity) {
  const double ways[2] = {(to[1] - from[1]) / h, (to[2] - from[2]) / h};
  const Vector3 v = rotationAbout(planeNormal(joint), -to[0]) * planeVector(joint, ways);
  velocity[0] = (to[0] - from[0]) / h;
  for (int axis : {1, 2}) {
    velocity[axis] = wayAlong(joint, axis, v) / joint.axes[axis].tail<3>().squaredNorm();
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

}  // namespace ambient
