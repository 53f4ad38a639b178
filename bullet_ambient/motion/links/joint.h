#pragma once

#include <array>

#include "bullet_ambient/spatial/spatial_vectors.h"
#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// Types of joints of a btMultiBody, with the values of its eFeatherstoneJointType.
enum class JointKind { kRevolute, kPrismatic, kSpherical, kPlanar, kFixed };

constexpr int kMaxJointAxes = 3;

/// Returns the number of degrees of freedom.
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

/// Position of a joint, in Bullet's form. Revolute: angle [rad]. Prismatic: displacement [m].
/// Spherical: unit quaternion x, y, z, w of the link in the axes of position zero. Planar: angle
/// [rad], and two displacements [m] in these axes.
using JointPosition = std::array<double, 4>;

/// Joint between a link and its parent. Frames of links: origin at the centre of mass, axes of
/// Bullet's link.
struct Joint {
  JointKind kind = JointKind::kFixed;
  Matrix3 zero_axes = Matrix3::Identity();    ///< the link's axes to its parent's at position zero
  Vector3 parent_to_pivot = Vector3::Zero();  ///< in the parent's frame [m]
  Vector3 pivot_to_link = Vector3::Zero();    ///< in the link's frame [m]
  /// Columns of S, docs/theory.md eq. (76): twist of the link relative to its parent, in the link's
  /// frame, for unit velocity along each axis. The first axisCount() are used.
  std::array<Vector6, kMaxJointAxes> axes{Vector6::Zero(), Vector6::Zero(), Vector6::Zero()};
};

/// Returns the angular speed of a joint with these velocities along its axes [rad/s].
double jointSpin(const Joint& joint, const double* velocity) noexcept;

/// Returns the pose of the link in its parent's frame.
FrameOffset linkOffset(const Joint& joint, const JointPosition& position) noexcept;

/// Returns the position that a joint reaches in the time h [s] with constant velocities along its
/// axes, by a screw motion of the link.
JointPosition moved(const Joint& joint, const JointPosition& position, const double* velocity,
                    double h) noexcept;

/// Writes to `velocity` the constant velocities by which Bullet's stepPositionsMultiDof moves a
/// joint from one position to another in the time h [s]. Inverse of moved(), except for planar
/// joints: Bullet rotates their displacement by the angle at the end of the step, and multiplies it
/// by the squared length of the axes. @pre rotation by less than pi
void velocityBetween(const Joint& joint, const JointPosition& from, const JointPosition& to,
                     double h, double* velocity) noexcept;

}  // namespace ambient
