#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "bullet_ambient/force/flow_settings.h"
#include "bullet_ambient/spatial/spatial_vectors.h"
#include "preprocess/shape/shape_description.h"

namespace ambient {

/// p_parent = pose * p_child [m].
using RigidPose = Eigen::Transform<double, 3, Eigen::Isometry, Eigen::DontAlign>;

/// A mesh file, taken as the convex hull of its vertices.
struct MeshHull {
  std::filesystem::path file;
  Vector3 scale{1, 1, 1};
};

/// A part of what a link collides with.
struct CollisionPart {
  std::variant<SphereShape, BoxShape, EllipsoidShape, CylinderShape, CapsuleShape, MeshHull> shape;
  RigidPose pose = RigidPose::Identity();  ///< in the link's frame
  std::string source;                      ///< begins every message about it: file, link and number
};

/// The types of joints that URDF files have; continuous ones are revolute without limits.
enum class UrdfJointKind { kFixed, kRevolute, kPrismatic, kPlanar, kFloating };

/// How a link moves against its parent. Forces and torques are in [N] and [N m], positions in [m]
/// and [rad], as the joint is prismatic or revolute.
struct JointModel {
  static constexpr double kUnlimited = std::numeric_limits<double>::infinity();

  std::string name;
  UrdfJointKind kind = UrdfJointKind::kFixed;
  /// Of the joint's frame, which is the link's at 0, in the parent's; of the root in the robot's.
  RigidPose origin = RigidPose::Identity();
  Vector3 axis{1, 0, 0};  ///< of length 1 in the joint's frame; of a plane its normal
  double lower = -kUnlimited, upper = kUnlimited;
  double effort = kUnlimited;    ///< that motors may use
  double velocity = kUnlimited;  ///< that motors may ask for
  double damping = 0;            ///< force per velocity
  double friction = 0;           ///< force
  struct Mimic {
    std::string joint;
    double multiplier = 1, offset = 0;
  };
  std::optional<Mimic> mimic;  ///< position = multiplier * that of the joint + offset

  bool isAxial() const {
    return kind == UrdfJointKind::kRevolute || kind == UrdfJointKind::kPrismatic;
  }
};

/// What <ambient .../> in a link says about its fluid.
struct LinkFluid {
  std::string medium;                ///< "water", "air", "none"; empty: the robot's
  std::filesystem::path fluid_body;  ///< .ambient file in the link's frame; empty: of its collision
  std::optional<PressureLaw> law;    ///< none: the robot's
};

/// A rigid part of a robot; without a mass it moves nothing by itself.
struct LinkModel {
  std::string name;
  int parent = -1;                                   ///< index, less than its own; -1: the root
  JointModel joint;                                  ///< to the parent
  double mass = 0;                                   ///< [kg]
  Vector3 centre_of_mass{0, 0, 0};                   ///< in the link's frame [m]
  Matrix3 inertia{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};  ///< about that, link's axes [kg m^2]
  std::vector<CollisionPart> collisions;
  std::optional<LinkFluid> fluid;
  /// Links that were merged into this one: their poses in its frame, by name.
  std::map<std::string, RigidPose> merged;
};

/// A tree of links, parents first. Plain data: nothing of it knows Bullet.
struct RobotModel {
  std::string name;
  std::string source;  ///< the file; begins every message
  std::vector<LinkModel> links;
  std::vector<std::string> warnings;  ///< what a user should know, one line each

  /// Index of a link, or of the one that it was merged into. @throws std::runtime_error in one line
  /// with the known names.
  int linkIndex(const std::string& link) const;
  /// Index of the link below a joint. @throws as linkIndex()
  int jointIndex(const std::string& joint) const;
};

/// Refuses what cannot move: a link that moves without mass or with moments of inertia that are not
/// positive, joints in a place where they cannot be. `fixed_base`: the root need not have a mass.
/// @throws std::runtime_error in one line that names file, link or joint, value and limit.
void checkRobot(const RobotModel& model, bool fixed_base);

/// The same robot with fewer links: what a fixed joint holds becomes part of its parent, with mass,
/// inertia and collisions, unless it says something about its fluid; a root without mass and
/// collisions vanishes where its only child floats.
RobotModel withoutFixedJoints(const RobotModel& model);

/// Poses of the links' frames, from that of the robot and the positions of revolute and prismatic
/// joints by name; others are at 0.
std::vector<RigidPose> linkPoses(const RobotModel& model, const RigidPose& robot,
                                 const std::map<std::string, double>& positions = {});

}  // namespace ambient
