#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "bullet_ambient/force/law/flow_settings.h"
#include "bullet_ambient/spatial/rotation.h"
#include "bullet_ambient/spatial/spatial_vectors.h"
#include "preprocess/shape/shapes.h"

namespace ambient {

/// The types of joints that URDF files have; continuous ones are revolute without limits.
enum class UrdfJointKind { kFixed, kRevolute, kPrismatic, kPlanar, kFloating };

/// Joint between a link and its parent. For prismatic joints forces are in [N] and positions in
/// [m], for revolute ones torques are in [N m] and positions in [rad].
struct JointModel {
  static constexpr double kUnlimited = std::numeric_limits<double>::infinity();

  std::string name;
  UrdfJointKind kind = UrdfJointKind::kFixed;
  /// Pose of the joint's frame in the parent link's frame; of the root link: in the robot's frame.
  /// The link's frame equals it at position 0.
  RigidPose origin = RigidPose::Identity();
  Vector3 axis{1, 0,
               0};  ///< unit axis in the joint's frame; for a planar joint the normal of the plane
  double lower = -kUnlimited, upper = kUnlimited;
  double effort = kUnlimited;    ///< largest effort of motors
  double velocity = kUnlimited;  ///< largest velocity that motors may ask for
  double damping = 0;            ///< force per velocity
  double friction = 0;           ///< force
  struct Mimic {
    std::string joint;
    double multiplier = 1, offset = 0;
  };
  std::optional<Mimic> mimic;  ///< position = multiplier * that of the joint + offset

  /// True if the position of the joint is one number.
  bool isAxial() const {
    return kind == UrdfJointKind::kRevolute || kind == UrdfJointKind::kPrismatic;
  }
  bool hasAxis() const { return isAxial() || kind == UrdfJointKind::kPlanar; }
  /// Pose of the link at a joint position, relative to that at position 0; the identity for a joint
  /// that is not axial.
  RigidPose motion(double position) const {
    RigidPose motion = RigidPose::Identity();
    if (kind == UrdfJointKind::kRevolute)
      motion.linear() = rotationFromVector(position * axis).toRotationMatrix();
    if (kind == UrdfJointKind::kPrismatic) motion.translation() = position * axis;
    return motion;
  }
};

/// Contents of the element <ambient .../> of a link.
struct LinkFluid {
  std::string medium;                ///< "water", "air", "none"; empty: the robot's
  std::filesystem::path fluid_body;  ///< .ambient file in the link's frame; empty: of its collision
  std::optional<PressureLaw> law;    ///< none: the robot's
  std::optional<double> roughness;   ///< FlowSettings::roughness [m]; none: the robot's
};

/// A rigid part of a robot; without a mass it moves nothing by itself.
struct LinkModel {
  std::string name;
  int parent = -1;                  ///< index, less than its own; -1: the root
  JointModel joint;                 ///< joint to the parent link
  double mass = 0;                  ///< [kg]
  Vector3 centre_of_mass{0, 0, 0};  ///< in the link's frame [m]
  Matrix3 inertia{
      {0, 0, 0}, {0, 0, 0}, {0, 0, 0}};  ///< about the centre of mass, link's axes [kg m^2]
  std::vector<PlacedShape> collisions;
  std::optional<LinkFluid> fluid;
  /// Links that were merged into this one: their poses in its frame, by name.
  std::map<std::string, RigidPose> merged;
};

/// A tree of links, parents first. Plain data, independent of Bullet.
struct RobotModel {
  std::string name;
  std::string source;  ///< the file; begins every message
  std::vector<LinkModel> links;
  std::vector<std::string> warnings;  ///< of a Robot: what a user should know, one line each

  /// Index of a link, or of the one that it was merged into. @throws std::runtime_error in one line
  /// with the known names.
  int linkIndex(const std::string& link) const;
  /// Index of the link below a joint. @throws as linkIndex()
  int jointIndex(const std::string& joint) const;
};

/// Checks that a robot can move: links that move, each with all that fixed joints hold to it, need
/// a mass and positive moments of inertia, and joints must be in allowed places. `fixed_base`: the
/// root needs no mass.
/// @throws std::runtime_error in one line that names file, link or joint, value and limit.
void checkRobot(const RobotModel& model, bool fixed_base);

/// Returns the robot with fixed joints removed: a link at a fixed joint becomes part of its parent,
/// with mass, inertia and collisions, unless it has an element `ambient`. A root without mass and
/// collisions is removed if its only child floats.
RobotModel withoutFixedJoints(const RobotModel& model);

/// Returns the robot with the collisions of each link without mass at the link with mass that fixed
/// joints hold to it, as they are one rigid body: parents before children. A link stays as it is if
/// it has an element `ambient`, or is held to a fixed base.
RobotModel withCarriedCollisions(RobotModel model, bool fixed_base);

/// Computes the poses of the links' frames from that of the robot and the positions of revolute and
/// prismatic joints by name; other joints are at 0.
std::vector<RigidPose> linkPoses(const RobotModel& model, const RigidPose& robot,
                                 const std::map<std::string, double>& positions = {});

/// Folders of packages by name, for references package://NAME/...
using PackageFolders = std::map<std::string, std::filesystem::path>;

/// Finds the file that a reference in `file` means:
///
///     meshes/hull.stl          beside the file
///     /data/hull.stl           as it is; file:///data/hull.stl is the same
///     package://rover/hull.stl in the folder of the package rover: the one that was given; else
///                              the nearest folder above the file that is called rover or holds a
///                              folder rover; model:// is the same
///
/// Environment variables are not read. Whether the file exists is not checked.
/// @throws std::runtime_error in one line that begins with `source`: another scheme, an empty name,
/// a package that was not found.
std::filesystem::path resolveReference(const std::string& reference,
                                       const std::filesystem::path& file,
                                       const PackageFolders& packages, const std::string& source);

/// Reads a URDF file: links, inertias, joints with limits, dynamics and mimics, collision geometry,
/// and three elements of our own, which other programs pass over:
///
///     <link name="blade">
///       <ambient medium="water" fluid_body="blade.ambient" law="form" roughness="3e-5"/>
///       <collision><geometry><capsule radius="0.1" length="0.5"/></geometry></collision>
///       <collision><geometry><ellipsoid semi_axes="0.1 0.2 0.3"/></geometry></collision>
///
/// Mesh files are not opened here. docs/robots.md has the rules.
/// @throws std::runtime_error in one line that names the file, the element, value and limit: also
/// if this library was built without tinyxml2.
RobotModel readUrdf(const std::filesystem::path& file, const PackageFolders& packages = {});

/// Reads a robot from a text; `file` stands for it in messages, and relative paths begin at its
/// folder.
RobotModel parseUrdf(const std::string& text, const std::filesystem::path& file,
                     const PackageFolders& packages = {});

}  // namespace ambient
