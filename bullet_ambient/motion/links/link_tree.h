#pragma once

#include <array>
#include <vector>

#include "bullet_ambient/motion/flight/flight.h"
#include "bullet_ambient/motion/links/link_kernel.h"
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

/// One link of a tree. Link 0 is the base, and link l is Bullet's l - 1. Frame of a link: origin at
/// its centre of mass, axes of Bullet's link. Members are constant unless comments say otherwise.
struct Link {
  int parent = -1;                    ///< index of the parent, smaller than the link's; base: -1
  Joint joint;                        ///< joint to the parent; unused for the base
  double mass = 0;                    ///< dry mass [kg]
  Vector3 inertia = Vector3::Zero();  ///< dry principal moments of inertia [kg m^2]

  /// Model of link and fluid, with the same dry mass and inertia; null: no fluid. May change
  /// between steps.
  const BodyModel* model = nullptr;
  /// Load at the end of its last flight, which the next one begins with; null: none is kept.
  FlightMemory* memory = nullptr;

  // Set in each step.
  Surroundings surroundings;                        ///< without a model, only `applied` is used
  std::array<double, kMaxJointAxes> joint_force{};  ///< along the axes of the joint [N m, N]
  /// True: the velocity is prescribed. Fixed or kinematic base, or kinematic link whose ancestors
  /// are all kinematic.
  bool keeps_velocity = false;
  bool keeps_position = false;  ///< true: kinematic link or base, which Bullet does not move
};

/// Links joined to a tree without loops. Its generalized velocities u are Bullet's, in the order of
/// btMultiBody::getVelocityVector(): angular and linear velocity of the base in W, then those of
/// the joints, link by link.
struct LinkTree : MultiBodySettings {
  std::vector<Link> links;  ///< at least the base; parents before children

  int size() const { return static_cast<int>(links.size()); }
};

/// Pose of a tree.
struct TreePose {
  Quaternion orientation = Quaternion::Identity();  ///< orientation of the base, B to W
  Vector3 position = Vector3::Zero();               ///< its centre of mass in W [m]
  std::vector<JointPosition> joints;                ///< one per link; the base's is unused
};

using Coordinates = Eigen::VectorXd;  ///< generalized velocities, accelerations or forces of a tree
using CoordinatesIn = Eigen::Ref<const Eigen::VectorXd>;
using CoordinatesOut = Eigen::Ref<Eigen::VectorXd>;

/// Returns the number of generalized velocities: 6, and one for each axis of all joints.
int coordinateCount(const LinkTree& tree);

/// @throws std::invalid_argument, naming link, value and limit, if parents do not come first, or a
/// mass or an inertia is negative or not finite.
void checkTree(const LinkTree& tree);

/// Moves base and joints by constant velocities for the time h [s], docs/theory.md eq. (80).
/// Bullet's stepPositionsMultiDof does the same, except for planar joints and if
/// turnsTooFastForBullet(). Does not allocate if `to` has the size. `to` may be `from`.
void movePose(const LinkTree& tree, const TreePose& from, const CoordinatesIn& u, double h,
              TreePose& to) noexcept;

/// True if Bullet cannot move a tree by u in h [s]: it limits rotations of the base and of
/// spherical joints to pi/4 per step.
bool turnsTooFastForBullet(const LinkTree& tree, const CoordinatesIn& u, double h) noexcept;

/// Computes the constant u by which Bullet moves a tree from one pose to another in h [s]. Leaves
/// entries of links that keep their position unchanged.
void velocityBetween(const LinkTree& tree, const TreePose& from, const TreePose& to, double h,
                     CoordinatesOut u) noexcept;

/// Motion of a tree at rest in the flow of its links; its joints are at rest.
struct RestInFlow {
  Vector3 velocity;  ///< of the base, W [m/s]: that of the flow, or 0 if its own is prescribed
  bool exists;  ///< false: links are in different flows, or the base is fixed in one that moves
};
RestInFlow restInFlow(const LinkTree& tree) noexcept;

/// Returns the velocity of the flow that the tree can follow, W [m/s]; 0: there is none.
inline Vector3 flowAround(const LinkTree& tree) noexcept {
  const RestInFlow rest = restInFlow(tree);
  return rest.exists ? rest.velocity : Vector3(Vector3::Zero());
}

/// Writes that motion. Returns whether it exists.
bool restInFlow(const LinkTree& tree, CoordinatesOut u) noexcept;

/// Calls restInFlow(). Returns true if that motion exists and all prescribed velocities in `u` are
/// 0.
bool findFlow(const LinkTree& tree, const CoordinatesIn& u, Coordinates& flow) noexcept;

}  // namespace ambient
