#pragma once

#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bullet_ambient/force/airy_waves.h"
#include "bullet_ambient/force/flow_settings.h"
#include "bullet_ambient/force/fluid_region.h"
#include "bullet_ambient/force/medium.h"
#include "bullet_ambient/motion/flight.h"
#include "bullet_ambient/spatial/vector_types.h"
#include "preprocess/robot/robot_model.h"
#include "preprocess/shape/shape_description.h"

namespace ambient {

/// How the fluid acts on the bodies of a scene.
enum class FluidModel {
  kAmbient,  ///< this library
  kIdeal,    ///< this library without surface loads: added mass and buoyancy alone
  kVacuum,   ///< stock Bullet
  kUwrbd,    ///< LinearDrag, Weissmann and Pinkall 2012
  kGwtf,     ///< WindwardFlux, a stand-in for Soliman et al. 2024
};

/// The scene file's words.
std::string modelName(FluidModel model);
std::string integratorName(Integrator integrator);

enum class MassKind { kUniform, kSurface };

/// A link of a robot of a scene, by their indices.
struct SceneLink {
  std::size_t robot = 0;
  std::size_t link = 0;
};

/// One rigid body of a scene. The shape's frame is that of the scene's "shape" entry, or the
/// link's.
struct BodyDef {
  std::string name;
  ShapeDescription shape;
  int waterline_table = 0;  ///< its subdivisions, as in BuildSettings; 0: none
  double mass = 0;          ///< [kg]; 0: static
  MassKind mass_kind = MassKind::kUniform;
  std::optional<Matrix3> inertia;         ///< about the centre of mass, shape's axes [kg m^2]
  std::optional<Vector3> centre_of_mass;  ///< in the shape's frame [m]
  Vector3 position = Vector3::Zero();     ///< of the centre of mass in W [m]
  Quaternion orientation = Quaternion::Identity();  ///< shape's axes to W
  Vector3 linear_velocity = Vector3::Zero();        ///< of the centre of mass in W [m/s]
  Vector3 angular_velocity = Vector3::Zero();       ///< in W [rad/s]
  FlowSettings flow;                                ///< separation, skin friction, reduced loads
  std::optional<double> fluid_density;              ///< overrides the medium's [kg/m^3]
  double wave_damping = 1;                          ///< of a floating body
  double restitution = 0;
  double friction = 0.5;
  std::optional<SceneLink> link;  ///< of a robot, which then has all that is not said here
  std::optional<Medium> medium;   ///< in place of the scene's
};

/// What a motor of a joint wants; position + amplitude sin(2 pi t / period + phase), or a velocity.
struct JointDrive {
  double position = 0;             ///< [rad] or [m]
  double amplitude = 0;            ///< [rad] or [m]
  double period = 1;               ///< [s]
  double phase = 0;                ///< [rad]
  std::optional<double> velocity;  ///< in place of a position [rad/s] or [m/s]
  double effort = std::numeric_limits<double>::infinity();  ///< [N m] or [N]
  double position_gain = 0.1;
  double velocity_gain = 1;

  double positionAt(double time) const;
  double velocityAt(double time) const;
};

/// A robot of a URDF file. Its links that collide are bodies of the scene, after the others.
struct RobotDef {
  std::string name;
  std::shared_ptr<const RobotModel> model;
  Vector3 position = Vector3::Zero();               ///< of the root link's frame in W [m]
  Quaternion orientation = Quaternion::Identity();  ///< root link's axes to W
  bool fixed_base = false;
  bool self_collision = false;
  std::map<std::string, double> joint_positions;  ///< at t = 0, by joint
  std::map<std::string, JointDrive> motors;       ///< by joint
  std::optional<Medium> medium;                   ///< of links that name none
  FlowSettings flow;

  RigidPose pose() const;
};

/// A joint without friction between two bodies, or of one with the world. Bodies that it joins do
/// not collide with each other.
struct JointDef {
  std::vector<std::string> bodies;  ///< names; one: joined to the world
  Vector3 point = Vector3::Zero();  ///< in W at t = 0 [m]
  std::optional<Vector3> axis;      ///< of a hinge, in W at t = 0; none: a ball joint
};

/// Water with a surface, which is level or carries waves. Above it is the scene's medium.
struct WaterDef {
  CalmSea sea;                       ///< up is against the scene's gravity
  std::vector<WaveComponent> waves;  ///< none: still
  Medium medium = water();
  std::optional<RegionBounds> bounds;  ///< of a pool; none: a sea
};

/// One scene, checked. SI units; W is the world frame.
struct Scene {
  std::string name;  ///< file name without extension
  std::string description;
  std::filesystem::path file;    ///< where it was read from
  std::string text;              ///< the whole scene after overrides, as JSON on one line
  double duration = 0;           ///< [s]
  double time_step = 0;          ///< [s]
  double output_step = 0;        ///< [s]
  Vector3 gravity{0, 0, -9.81};  ///< [m/s^2]
  Medium medium = air();
  std::optional<WaterDef> water;
  std::vector<FluidRegion> regions;  ///< others, filled with one medium each
  FluidModel model = FluidModel::kAmbient;
  PressureLaw law = PressureLaw::kPublished;  ///< of bodies that do not name theirs
  double linear_drag_speed = 1;               ///< of FluidModel::kUwrbd [m/s]
  FlightSettings flight;
  int threads = 0;  ///< of the preprocessing; 0: all cores
  std::vector<BodyDef> bodies;
  std::vector<RobotDef> robots;
  std::vector<JointDef> joints;
};

}  // namespace ambient
