#pragma once

#include <BulletDynamics/Featherstone/btMultiBody.h>

#include <map>
#include <memory>
#include <string>

#include "bullet_ambient/bullet/precision_check.h"
#include "preprocess/robot/link_shape.h"
#include "preprocess/robot/robot_model.h"

class btMultiBodyDynamicsWorld;

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {

class RobotJoints;

/// How a robot begins.
struct RobotSettings {
  RigidPose pose = RigidPose::Identity();  ///< of the robot's frame, the root link's, in W
  bool fixed_base = false;
  std::map<std::string, double> positions;  ///< of revolute and prismatic joints; others: 0
  bool self_collision = false;              ///< between links that no joint connects
  bool can_sleep = false;
};

/// What a motor wants of a revolute or prismatic joint. A step ends, where the effort suffices,
/// with the velocity
///
///     velocity + velocity_gain * (target.velocity - velocity)
///              + position_gain * (target.position - position) / time step
struct MotorTarget {
  double position = 0;  ///< [rad] or [m]
  double velocity = 0;  ///< [rad/s] or [m/s]
  double position_gain = 0.1;
  double velocity_gain = 1;
  double effort = JointModel::kUnlimited;  ///< [N m] or [N]; at most the joint's
};

/// A btMultiBody made from a model, and all that belongs to it: shapes, colliders, limits, mimics,
/// motors. Bullet's own damping of multibodies is off: the fluid's is ours. Joints' friction and
/// damping never turn a velocity round.
class Robot {
 public:
  /// For fewer links: withoutFixedJoints(model).
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

  /// Bullet's number of a link, or of the one that it was merged into; -1: the base.
  /// @throws std::runtime_error with the known names.
  int linkNumber(const std::string& link) const { return model_.linkIndex(link) - 1; }
  /// Bullet's number of the link below a joint. @throws as linkNumber()
  int jointNumber(const std::string& joint) const { return model_.jointIndex(joint) - 1; }

  /// Of a link by Bullet's number.
  const LinkModel& link(int number) const { return model_.links.at(indexOf(number)); }
  const LinkShape& shape(int number) const { return shapes_.at(indexOf(number)); }
  const RigidPose& linkInBody(int number) const { return frames_.at(indexOf(number)).link_in_body; }
  /// Of Bullet's frame of the link in W, now: that of its collider, which is never a step behind.
  const btTransform& bodyTransform(int number) const;
  /// Of its own frame in W, now.
  RigidPose linkPose(int number) const;
  /// The same by name, also of a link that was merged. @throws as linkNumber()
  RigidPose linkPose(const std::string& link) const;

  /// Of a revolute or prismatic joint. @throws as linkNumber()
  double position(const std::string& joint) const;
  double velocity(const std::string& joint) const;

  /// Drives a revolute or prismatic joint from now on; effort 0: no longer. Mimics follow.
  /// @throws std::runtime_error for another joint or numbers that are not finite.
  void setMotor(const std::string& joint, const MotorTarget& target);

  /// Before each step of the world (or substep), with its length [s]: turns efforts into impulses.
  void prepareStep(double time_step);

 private:
  static std::size_t indexOf(int number) { return static_cast<std::size_t>(number) + 1; }
  void makeBody(const RobotSettings& settings);
  void setUpLink(std::size_t index);
  void place(const RobotSettings& settings);
  void makeColliders();
  void checkAxial(const std::string& joint) const;

  RobotModel model_;
  std::vector<LinkMassFrame> frames_;
  std::vector<LinkShape> shapes_;
  std::unique_ptr<btMultiBody> body_;
  std::vector<std::unique_ptr<btCollisionObject>> colliders_;
  std::unique_ptr<RobotJoints> joints_;
  btMultiBodyDynamicsWorld* world_ = nullptr;
};

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
