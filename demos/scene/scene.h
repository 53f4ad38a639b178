#pragma once

#include <array>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bullet_ambient/force/law/propeller.h"
#include "bullet_ambient/force/loads/foils.h"
#include "bullet_ambient/force/medium/fluid_region.h"
#include "bullet_ambient/force/medium/medium.h"
#include "bullet_ambient/force/medium/waves.h"
#include "bullet_ambient/immersed/attach_def.h"
#include "bullet_ambient/motion/flight/flight.h"
#include "bullet_ambient/spatial/vector_types.h"
#include "demos/integrators/integrators.h"
#include "preprocess/robot/robot_model.h"
#include "preprocess/shape/shapes.h"

namespace ambient {

/// Model of the fluid's action on the bodies of a scene.
enum class FluidModel {
  kAmbient,  ///< this library
  kIdeal,    ///< this library without surface loads: only added mass and buoyancy
  kVacuum,   ///< stock Bullet
  kUwrbd,    ///< LinearDrag, Weissmann and Pinkall 2012
  kGwtf,     ///< WindwardFlux, a stand-in for Soliman et al. 2024
};

/// Words of scene files; integrators and laws have kIntegratorNames and kPressureLawNames.
constexpr std::array<std::pair<FluidModel, const char*>, 5> kFluidModelNames{
    {{FluidModel::kAmbient, "ambient"},
     {FluidModel::kIdeal, "ideal"},
     {FluidModel::kVacuum, "vacuum"},
     {FluidModel::kUwrbd, "uwrbd"},
     {FluidModel::kGwtf, "gwtf"}}};

enum class MassKind { kUniform, kSurface };

/// Index of a robot in Scene::robots, and index of a link in the robot's model.
struct SceneLink {
  std::size_t robot = 0;
  std::size_t link = 0;
};

/// One rigid body of a scene. The shape's frame is that of the scene's "shape" entry, or the frame
/// of the link.
struct BodyDef {
  std::string name;
  ShapeDescription shape;
  int waterline_table = 0;  ///< subdivisions of the waterline table, see BuildSettings; 0: none
  double mass = 0;          ///< [kg]; 0: static
  MassKind mass_kind = MassKind::kUniform;
  std::optional<Matrix3> inertia;         ///< about the centre of mass, shape's axes [kg m^2]
  std::optional<Vector3> centre_of_mass;  ///< in the shape's frame [m]
  Vector3 position = Vector3::Zero();     ///< centre of mass in W at t = 0 [m]
  Quaternion orientation = Quaternion::Identity();  ///< shape's axes to W
  Vector3 linear_velocity = Vector3::Zero();        ///< velocity of the centre of mass in W [m/s]
  Vector3 angular_velocity = Vector3::Zero();       ///< in W [rad/s]
  AttachDef attach;  ///< without its fluid body and the scene's integrator
  double restitution = 0;
  double friction = 0.5;
  std::optional<SceneLink> link;  ///< of a robot, which then has all that is not said here
};

/// Target of a joint's motor: position + amplitude sin(2 pi t / period + phase), or `velocity`.
struct JointDrive {
  double position = 0;             ///< [rad] or [m]
  double amplitude = 0;            ///< [rad] or [m]
  double period = 1;               ///< [s]
  double phase = 0;                ///< [rad]
  std::optional<double> velocity;  ///< target velocity, replaces a position [rad/s] or [m/s]
  double effort = std::numeric_limits<double>::infinity();  ///< largest torque or force [N m], [N]
  double position_gain = 0.1;
  double velocity_gain = 1;

  double positionAt(double time) const;
  double velocityAt(double time) const;
};

/// Robot of a URDF file. Links with collision shapes are bodies of the scene, after all others.
struct RobotDef {
  std::string name;
  std::shared_ptr<const RobotModel> model;
  Vector3 position = Vector3::Zero();               ///< origin of the root link's frame in W [m]
  Quaternion orientation = Quaternion::Identity();  ///< root link's axes to W
  Vector3 linear_velocity = Vector3::Zero();   ///< of the root link's centre of mass in W [m/s]
  Vector3 angular_velocity = Vector3::Zero();  ///< of the root link in W [rad/s]
  bool fixed_base = false;
  bool self_collision = false;
  std::map<std::string, double> joint_positions;   ///< positions at t = 0 by name of the joint
  std::map<std::string, double> joint_velocities;  ///< velocities at t = 0
  std::map<std::string, JointDrive> motors;        ///< motors by name of the joint
  std::optional<Medium> medium;                    ///< medium of links that name none
  FlowSettings flow;

  RigidPose pose() const;
};

/// Frictionless joint between two bodies, or between one body and the world. Joined bodies do not
/// collide with each other.
struct JointDef {
  std::vector<std::string> bodies;  ///< one or two names; one: joint to the world
  Vector3 point = Vector3::Zero();  ///< in W at t = 0 [m]
  std::optional<Vector3> axis;      ///< axis of a hinge in W at t = 0; none: ball joint
};

/// Points command, value with rising commands.
using CommandCurve = std::vector<std::pair<double, double>>;

/// Value of a curve for a command, linear in between, that of the ends beyond.
double valueAt(const CommandCurve& curve, double command);

/// A propeller, jet or rotor that pushes a body. Frame: that of the body's shape or link. What
/// drives it follows the command: the thrust; with a propeller by numbers its turns, and of an
/// ideal disc the thrust at rest.
struct ThrusterDef {
  std::string name;
  std::size_t body = 0;                ///< index in Scene::bodies
  Vector3 position = Vector3::Zero();  ///< [m]
  Vector3 axis = Vector3::UnitX();     ///< direction of a positive thrust, unit
  CommandCurve curve;                  ///< command, drive [N] or [1/s]
  double command = 0;                  ///< at the start
  double lag = 0;                      ///< time constant of the drive [s]
  double radius = 0;                   ///< of the disc [m]; 0: it is never dry
  double torque_per_thrust = 0;        ///< torque about the axis over the thrust [m]
  std::optional<Propeller> propeller;  ///< none: the drive is the thrust
  bool is_left_handed = false;         ///< turns backwards about the axis where it pushes along it
  bool washes_bodies = false;  ///< its wash is a flow that all bodies feel, not its foils alone
};

/// A wing, fin or rudder by its numbers, on a body. Frame: that of the body's shape or link.
struct FoilDef {
  std::string name;
  std::size_t body = 0;  ///< index in Scene::bodies
  Foil foil;
  CommandCurve curve;  ///< command, angle [rad]; empty: it does not turn
  double command = 0;  ///< at the start
  double lag = 0;      ///< time constant of the angle [s]
};

/// Water with a surface, still or with waves. The fluid above the surface is Scene::medium.
struct WaterDef {
  CalmSea sea;                       ///< sea.up is against the scene's gravity
  std::vector<WaveComponent> waves;  ///< empty: still water
  Medium medium = water();
  std::optional<RegionBounds> bounds;  ///< bounds of a pool; none: a sea
  FluidRegion flows;  ///< flow, flow_above and layers of the water's region; the rest is not read
};

/// One scene, checked. SI units; W is the world frame.
struct Scene {
  std::string name;  ///< file name without extension
  std::string description;
  std::filesystem::path file;    ///< file the scene was read from
  std::string text;              ///< whole scene after overrides, as JSON on one line
  double duration = 0;           ///< [s]
  double time_step = 0;          ///< [s]
  double output_step = 0;        ///< [s]
  Vector3 gravity{0, 0, -9.81};  ///< [m/s^2]
  Medium medium = air();
  std::optional<WaterDef> water;
  std::vector<FluidRegion> regions;  ///< regions without surface
  FluidModel model = FluidModel::kAmbient;
  PressureLaw law = PressureLaw::kForm;  ///< law of bodies that name none
  double linear_drag_speed = 1;          ///< speed c of linearDrag(), for kUwrbd [m/s]
  FlightSettings flight;
  int threads = 0;  ///< threads of the preprocessing; 0: all cores
  std::vector<BodyDef> bodies;
  std::vector<RobotDef> robots;
  std::vector<JointDef> joints;
  std::vector<ThrusterDef> thrusters;
  std::vector<FoilDef> foils;
};

}  // namespace ambient
