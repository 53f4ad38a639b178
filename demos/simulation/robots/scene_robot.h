#pragma once

#include <BulletDynamics/Featherstone/btMultiBodyJointFeedback.h>

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "bullet_ambient/spatial/spatial_vectors.h"
#include "demos/analysis/motion_sample.h"
#include "demos/scene/scene.h"
#include "preprocess/robot/robot.h"

namespace ambient {

/// Robot of a scene in a world, with the motion of its motors.
class SceneRobot {
 public:
  /// @throws std::runtime_error as the constructor of Robot
  explicit SceneRobot(const RobotDef& def);

  Robot& robot() { return robot_; }
  const Robot& robot() const { return robot_; }

  /// Sets the motors' targets for the step from `time` to time + time_step [s].
  void prepareStep(double time, double time_step);

  /// Drives a revolute or prismatic joint from now on, in place of the scene's motor.
  /// @throws std::runtime_error as Robot::setMotor()
  void setDrive(const std::string& joint, const JointDrive& drive);
  /// Adds a torque [N m] or force [N] at a revolute or prismatic joint for the next step. Limits of
  /// effort bound motors only. @throws std::runtime_error as Robot::position(), or if it is not
  /// finite
  void addJointTorque(const std::string& joint, double torque);

  /// Computes the wrench in a joint in each step from now on.
  /// @throws std::runtime_error as Robot::jointNumber()
  void measure(const std::string& joint);
  /// Wrench of the parent on the link below a joint during the last step, about the origin of the
  /// link's frame, world axes, without the effort of the joint's own motor. 0 before a step.
  /// @throws std::runtime_error if the joint is not measured.
  Wrench jointWrench(const std::string& joint) const;

  /// Motion of a link of the model, orientation of the link's own axes; sample.time is not set.
  MotionSample sample(std::size_t link) const;

 private:
  RobotDef def_;
  Robot robot_;
  std::map<int, btMultiBodyJointFeedback> measured_;  ///< by Bullet's number of the link
  mutable std::vector<btVector3> angular_, linear_;   ///< of sample(): velocities in link frames
};

}  // namespace ambient
