#pragma once

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointMotor.h>

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "bullet_ambient/attach_world.h"
#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/fluid.h"
#include "preprocess/robot/link_shape.h"
#include "preprocess/robot/robot_model.h"

AMBIENT_BEGIN

/// Target of a motor at a revolute or prismatic joint. If the effort suffices, a step ends with the
/// joint velocity
///
///     velocity + velocity_gain * (target.velocity - velocity)
///              + position_gain * (target.position - position) / time step
struct MotorTarget {
  double position = 0;  ///< [rad] or [m]
  double velocity = 0;  ///< [rad/s] or [m/s]
  double position_gain = 0.1;
  double velocity_gain = 1;
  double effort = JointModel::kUnlimited;  ///< [N m] or [N]; at most the joint's

  /// Returns the target of a motor that holds a velocity [rad/s or m/s], whatever the position.
  static MotorTarget speed(double velocity, double effort = JointModel::kUnlimited) {
    return {0, velocity, 0, 1, effort};
  }
};

/// The constraints of a robot's joints: limits, mimics, brakes for friction and damping, motors.
class RobotJoints {
 public:
  RobotJoints(const RobotModel& model, btMultiBody& body);

  void addTo(btMultiBodyDynamicsWorld& world);
  void leaveWorld();
  void setMotor(int number, const MotorTarget& target);
  void prepareStep(double time_step);
  /// Torque [N m] or force [N] of the motor in the last step; 0: the joint has no motor.
  double motorEffort(int number) const;

 private:
  struct Motor {
    std::unique_ptr<btMultiBodyJointMotor> constraint;
    double effort = 0;
  };

  void makeLimit(int number, const JointModel& joint);
  void makeMimic(int number, const JointModel::Mimic& mimic);
  std::unique_ptr<btMultiBodyJointMotor> makeMotor(int number);
  const JointModel& joint(int number) const;
  std::vector<btMultiBodyConstraint*> all() const;

  const RobotModel& model_;
  btMultiBody& body_;
  std::vector<std::unique_ptr<btMultiBodyConstraint>> passive_;
  std::map<int, std::unique_ptr<btMultiBodyJointMotor>> brakes_;  // by link
  std::map<int, Motor> motors_;
  btMultiBodyDynamicsWorld* world_ = nullptr;
  double time_step_ = 0;  ///< step length given to prepareStep() [s]; 0: none yet
};

class RobotJoints;

/// Initial state and settings of a robot.
struct RobotSettings {
  RigidPose pose =
      RigidPose::Identity();  ///< pose of the robot's frame, that of the root link, in W
  bool fixed_base = false;
  /// Motion of the root link: velocity of its centre of mass, world axes. @pre zero for a fixed
  /// base
  Twist twist_W;
  std::map<std::string, double>
      positions;  ///< positions of revolute and prismatic joints by name [rad, m]; others: 0
  std::map<std::string, double> velocities;  ///< their velocities [rad/s, m/s]; others: 0
  bool self_collision = false;               ///< true: links that no joint connects collide
  bool can_sleep = false;
};

/// A btMultiBody made from a model, with its shapes, colliders, limits, mimics and motors. Bullet's
/// own damping of multibodies is off, and its limit of 100 rad/s; the fluid damps. Friction and
/// damping of joints never reverse a velocity.
class Robot {
 public:
  /// For fewer links: withoutFixedJoints(model). Collisions are those of withCarriedCollisions().
  /// @throws std::runtime_error in one line as checkRobot() and makeLinkShape(), for a pose or
  /// positions that are not finite, or a joint that is not known.
  explicit Robot(RobotModel model, const RobotSettings& settings = {});
  /// Leaves its world.
  ~Robot();
  Robot(const Robot&) = delete;
  Robot& operator=(const Robot&) = delete;

  /// Adds multibody, colliders and constraints. The world must outlive the robot, or leaveWorld()
  /// be called before. @pre it is in no world
  void addTo(btMultiBodyDynamicsWorld& world);
  void leaveWorld();

  const RobotModel& model() const { return model_; }
  btMultiBody& multiBody() { return *body_; }
  const btMultiBody& multiBody() const { return *body_; }

  /// Bullet's number of a link, or of the link that it was merged into; -1: the base.
  /// @throws std::runtime_error with the known names.
  int linkNumber(const std::string& link) const { return model_.linkIndex(link) - 1; }
  /// Bullet's number of the link below a joint. @throws as linkNumber()
  int jointNumber(const std::string& joint) const { return model_.jointIndex(joint) - 1; }

  /// Model, collision shapes and frame of a link, by Bullet's number of it (-1: the base).
  const LinkModel& link(int number) const { return model_.links.at(indexOf(number)); }
  const LinkShape& shape(int number) const { return shapes_.at(indexOf(number)); }
  const RigidPose& linkInBody(int number) const { return frames_.at(indexOf(number)).link_in_body; }
  /// Returns the current pose of Bullet's body frame of a link in W. It is read from the collider,
  /// which is never a step behind.
  const btTransform& bodyTransform(int number) const;
  /// Returns the current pose of the link's own frame in W, by Bullet's number.
  RigidPose linkPose(int number) const;
  /// Returns the current pose in W of a link by name, also of one that was merged into another.
  /// @throws as linkNumber()
  RigidPose linkPose(const std::string& link) const;

  /// Position [rad] or [m] and velocity [rad/s] or [m/s] of a revolute or prismatic joint.
  /// @throws std::runtime_error as linkNumber()
  double position(const std::string& joint) const;
  double velocity(const std::string& joint) const;

  /// Sets the pose of the robot's frame, that of the root link, in W.
  /// @throws std::runtime_error if it is not finite.
  void setPose(const RigidPose& pose);
  /// Sets the motion of the root link: velocity of its centre of mass, world axes. That of a fixed
  /// base must be zero. Joints keep their velocities.
  /// @throws std::runtime_error if it is not finite.
  void setTwist(const Twist& twist_W);
  /// Sets the position [rad] or [m] or the velocity [rad/s] or [m/s] of a revolute or prismatic
  /// joint. @throws std::runtime_error as requireAxial(), or if it is not finite
  void setPosition(const std::string& joint, double position);
  void setVelocity(const std::string& joint, double velocity);

  /// Torque [N m] or force [N] that the motor of a revolute or prismatic joint used in the last
  /// step.
  /// @throws std::runtime_error as linkNumber()
  double motorEffort(const std::string& joint) const;
  /// @throws std::runtime_error if a joint is not revolute or prismatic, or as linkNumber()
  void requireAxial(const std::string& joint) const;

  /// Drives a revolute or prismatic joint from now on; effort 0 ends that. Mimic joints follow.
  /// @throws std::runtime_error for another joint or numbers that are not finite.
  void setMotor(const std::string& joint, const MotorTarget& target);

  /// Call before each step (or substep) of the world, with its length [s]: converts efforts to
  /// impulses.
  void prepareStep(double time_step);

 private:
  static std::size_t indexOf(int number) { return static_cast<std::size_t>(number) + 1; }
  void makeBody(const RobotSettings& settings);
  void setUpLink(std::size_t index);
  void requireFinite(const std::string& joint, const char* what, double value) const;
  void moveColliders();
  void makeColliders();

  RobotModel model_;
  std::vector<LinkMassFrame> frames_;
  std::vector<LinkShape> shapes_;
  std::unique_ptr<btMultiBody> body_;
  std::vector<std::unique_ptr<btCollisionObject>> colliders_;
  std::unique_ptr<RobotJoints> joints_;
  btMultiBodyDynamicsWorld* world_ = nullptr;
};

/// Puts all links of a robot that collide and move into a fluid: with the medium, law and fluid
/// body that their `ambient` elements name, else with those of `def` and the fluid body that the
/// source has for the collision shape.
///
///     Robot robot(withoutFixedJoints(readUrdf("rover.urdf")));
///     robot.addTo(world);
///     FluidBodyCache shapes;
///     attachRobot(fluid, robot, shapes, def);
///
/// Returns the names of the links that are in a fluid now. Remove them, or destroy the fluid,
/// before the robot.
/// @throws std::runtime_error or std::invalid_argument in one line that names the link; then none
/// of them is attached.
std::vector<std::string> attachRobot(Fluid& fluid, Robot& robot, FluidBodySource& source,
                                     const AttachDef& def);

/// Returns the pose of F in Bullet's body frame of a link, for a fluid body whose frame F is the
/// URDF link's frame.
FrameOffset linkFluidFrame(const Robot& robot, int number);

AMBIENT_END
