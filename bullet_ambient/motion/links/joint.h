#pragma once

#include <array>

#include "bullet_ambient/spatial/frame_offset.h"
#include "bullet_ambient/spatial/spatial_vectors.h"

namespace ambient {

/// The joints that a btMultiBody knows, with the numbers of its eFeatherstoneJointType.
enum class JointKind { kRevolute, kPrismatic, kSpherical, kPlanar, kFixed };

constexpr int kMaxJointAxes = 3;

/// Degrees of freedom.
constexpr int axisCount(JointKind kind) {
  switch (kind) {
    case JointKind::kFixed:
      return 0;
    case JointKind::kRevolute:
    case JointKind::kPrismatic:
      return 1;
    default:
      return 3;
  }
}

/// Whether the position is a quaternion. Bullet follows turns of such joints up to pi/4 in a step.
constexpr bool hasQuaternion(JointKind kind) { return kind == JointKind::kSpherical; }

/// Position of a joint, as Bullet keeps it: angle [rad]; way [m]; unit quaternion x, y, z, w of the
/// link in the axes of position zero; or angle and two ways in these axes.
using JointPosition = std::array<double, 4>;

/// Joint between a link and its parent. Frames of links: origin at the centre of mass, axes of
/// Bullet's link.
struct Joint {
  JointKind kind = JointKind::kFixed;
  /// Turns vectors from the parent's axes to the link's where the position is zero.
  Quaternion zero_rotation = Quaternion::Identity();
  Vector3 parent_to_pivot = Vector3::Zero();  ///< in the parent's frame [m]
  Vector3 pivot_to_link = Vector3::Zero();    ///< in the link's frame [m]
  /// Columns of S: twists of the link, relative to its parent and in the link's frame, by unit
  /// velocities of the joint; the first axisCount() are used.
  std::array<Vector6, kMaxJointAxes> axes{Vector6::Zero(), Vector6::Zero(), Vector6::Zero()};
};

/// Speed of turning about a joint with these velocities along its axes [rad/s].
double jointSpin(const Joint& joint, const double* velocity) noexcept;

/// Axes of the link in its parent's, where the position is zero.
Matrix3 zeroAxes(const Joint& joint) noexcept;

/// Pose of the link in its parent's frame. `zero_axes`: zeroAxes() of the joint.
FrameOffset linkOffset(const Joint& joint, const Matrix3& zero_axes,
                       const JointPosition& position) noexcept;
inline FrameOffset linkOffset(const Joint& joint, const JointPosition& position) noexcept {
  return linkOffset(joint, zeroAxes(joint), position);
}

/// Position that the joint reaches in time h [s] with constant velocities along its axes: the link
/// turns and slides along one screw.
JointPosition moved(const Joint& joint, const JointPosition& position, const double* velocity,
                    double h) noexcept;

/// The constant velocities by which Bullet's stepPositionsMultiDof comes from one position to
/// another in time h, into `velocity`; turns of less than half a revolution. Those of moved(), but
/// for planar joints: Bullet turns their ways by the angle at the end, and scales them by the
/// square of the axes, which it does not normalise.
void velocityBetween(const Joint& joint, const JointPosition& from, const JointPosition& to,
                     double h, double* velocity) noexcept;

}  // namespace ambient
