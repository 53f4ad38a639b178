#pragma once

#include <array>
#include <vector>

#include "bullet_ambient/motion/flight/flight_task.h"
#include "bullet_ambient/motion/links/joint.h"

namespace ambient {

/// One link of a tree: constant, but for what the comment says. Link 0 is the base, and link l is
/// Bullet's l - 1. Frame of a link: origin at its centre of mass, axes of Bullet's link.
struct Link {
  int parent = -1;                    ///< comes before the link; -1 for the base alone
  Joint joint;                        ///< of no meaning for the base
  double mass = 0;                    ///< without fluid [kg]
  Vector3 inertia = Vector3::Zero();  ///< principal moments, without fluid [kg m^2]

  /// Link and fluid, of the same mass and inertia; null without a fluid. May change between steps.
  const BodyModel* model = nullptr;

  // Set anew in each step.
  Surroundings surroundings;                        ///< all but `applied` count with a model only
  std::array<double, kMaxJointAxes> joint_force{};  ///< along the axes of the joint [N m, N]
  /// Prescribed: base that is fixed or kinematic, link that is kinematic with all its ancestors.
  bool keeps_velocity = false;
  bool keeps_position = false;  ///< Bullet does not move it: kinematic, whatever its ancestors
};

/// Links joined to a tree without loops. Its generalized velocities u are Bullet's, in the order of
/// btMultiBody::getVelocityVector(): angular and linear velocity of the base in W, then those of
/// the joints, link by link.
struct LinkTree {
  std::vector<Link> links;          ///< at least the base; parents before children
  double linear_damping = 0;        ///< Bullet's, of the dry mass [1/s and 1/m]
  double angular_damping = 0;       ///< [1/s and 1]
  bool has_gyroscopic_term = true;  ///< w x J w of the dry inertia (btMultiBody's switch)

  int size() const { return static_cast<int>(links.size()); }
};

/// Pose of a tree.
struct TreePose {
  Quaternion orientation = Quaternion::Identity();  ///< of the base, B to W
  Vector3 position = Vector3::Zero();               ///< of its centre of mass, in W [m]
  std::vector<JointPosition> joints;                ///< one per link; that of the base is unused
};

using Coordinates = Eigen::VectorXd;  ///< as many as a tree has generalized velocities
using CoordinatesIn = Eigen::Ref<const Eigen::VectorXd>;
using CoordinatesOut = Eigen::Ref<Eigen::VectorXd>;

/// First entry of each link's joint in u.
std::vector<int> firstCoordinates(const LinkTree& tree);
/// Entries of u: 6 and the axes of all joints.
int coordinateCount(const LinkTree& tree);

/// @throws std::invalid_argument, naming link, value and limit, if parents do not come first, or a
/// mass or an inertia is negative or not finite.
void checkTree(const LinkTree& tree);

/// q + h u: base and joints moved by constant velocities, as Bullet's stepPositionsMultiDof does
/// (up to turnsTooFastForBullet(), and its planar joints). Does not allocate if `to` has the
/// size. `to` may be `from`.
void movePose(const LinkTree& tree, const TreePose& from, const CoordinatesIn& u, double h,
              TreePose& to) noexcept;

/// Whether Bullet moves it by less: it turns a base and spherical joints by pi/4 in a step at most.
bool turnsTooFastForBullet(const LinkTree& tree, const CoordinatesIn& u, double h) noexcept;

/// The constant u by which Bullet comes from one pose to another in time h. Entries of links that
/// keep their position stay as they are.
void velocityBetween(const LinkTree& tree, const TreePose& from, const TreePose& to, double h,
                     CoordinatesOut u) noexcept;

/// u of a tree that is at rest in the flow of its links: the base's velocity if it floats, else
/// zero. False if no such motion exists: links are in different flows, or held in one that moves.
bool restInFlow(const LinkTree& tree, CoordinatesOut u) noexcept;

/// Finds u at rest in the flow, if all kept velocities of that motion are those of `u`.
bool findFlow(const LinkTree& tree, const CoordinatesIn& u, Coordinates& flow) noexcept;

}  // namespace ambient
