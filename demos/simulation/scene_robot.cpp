#include "demos/simulation/scene_robot.h"

#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

#include <vector>

#include "bullet_ambient/bullet/conversions.h"

namespace ambient {
namespace {

RobotSettings settingsOf(const RobotDef& def) {
  RobotSettings settings;
  settings.pose = def.pose();
  settings.fixed_base = def.fixed_base;
  settings.positions = def.joint_positions;
  settings.self_collision = def.self_collision;
  return settings;
}

MotorTarget targetOf(const JointDrive& drive, double time, double time_step) {
  MotorTarget target;
  target.position = drive.positionAt(time);
  target.velocity = drive.velocityAt(time + time_step);
  target.position_gain = drive.velocity ? 0 : drive.position_gain;
  target.velocity_gain = drive.velocity_gain;
  target.effort = drive.effort;
  return target;
}

/// Velocities of the centres of mass and of the axes, in W; Bullet has them in the links' frames.
std::vector<Twist> linkTwists(const Robot& robot) {
  const btMultiBody& body = robot.multiBody();
  std::vector<btVector3> angular(static_cast<std::size_t>(body.getNumLinks() + 1));
  std::vector<btVector3> linear(angular.size());
  body.compTreeLinkVelocities(angular.data(), linear.data());
  std::vector<Twist> twists;
  for (int i = -1; i < body.getNumLinks(); ++i) {
    const std::size_t at = static_cast<std::size_t>(i) + 1;
    const btMatrix3x3& to_W = robot.bodyTransform(i).getBasis();
    twists.push_back({toVector3(to_W * angular[at]), toVector3(to_W * linear[at])});
  }
  return twists;
}

}  // namespace

SceneRobot::SceneRobot(const RobotDef& def) : def_(def), robot_(*def.model, settingsOf(def)) {}

void SceneRobot::prepareStep(double time, double time_step) {
  for (const auto& [joint, drive] : def_.motors)
    robot_.setMotor(joint, targetOf(drive, time, time_step));
  robot_.prepareStep(time_step);
}

MotionSample SceneRobot::sample(std::size_t link) const {
  const RigidPose pose = robot_.linkPose(static_cast<int>(link) - 1);
  MotionSample sample;
  sample.position = pose * robot_.model().links[link].centre_of_mass;
  sample.orientation = Quaternion(Matrix3(pose.linear()));
  sample.twist = linkTwists(robot_)[link];
  return sample;
}

}  // namespace ambient
