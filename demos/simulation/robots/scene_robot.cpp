#include "demos/simulation/robots/scene_robot.h"

#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

#include <cmath>

#include "bullet_ambient/bullet/core/conversions.h"
#include "preprocess/mesh/input_error.h"

namespace ambient {
namespace {

RobotSettings settingsOf(const RobotDef& def) {
  RobotSettings settings;
  settings.pose = def.pose();
  settings.fixed_base = def.fixed_base;
  settings.twist_W = {def.angular_velocity, def.linear_velocity};
  settings.positions = def.joint_positions;
  settings.velocities = def.joint_velocities;
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

}  // namespace

SceneRobot::SceneRobot(const RobotDef& def)
    : def_(def),
      robot_(*def.model, settingsOf(def)),
      angular_(static_cast<std::size_t>(robot_.multiBody().getNumLinks()) + 1),
      linear_(angular_.size()) {}

void SceneRobot::prepareStep(double time, double time_step) {
  for (const auto& [joint, drive] : def_.motors)
    robot_.setMotor(joint, targetOf(drive, time, time_step));
  robot_.prepareStep(time_step);
}

void SceneRobot::setDrive(const std::string& joint, const JointDrive& drive) {
  robot_.setMotor(joint, targetOf(drive, 0, 0));
  def_.motors[joint] = drive;
}

void SceneRobot::addJointTorque(const std::string& joint, double torque) {
  robot_.requireAxial(joint);
  if (!std::isfinite(torque))
    raiseInputError(robot_.model().source, "the torque of joint \"", joint, "\" is not finite");
  robot_.multiBody().addJointTorque(robot_.jointNumber(joint), static_cast<btScalar>(torque));
}

void SceneRobot::measure(const std::string& joint) {
  const int number = robot_.jointNumber(joint);
  btMultiBodyJointFeedback none;
  none.m_reactionForces.setZero();
  robot_.multiBody().getLink(number).m_jointFeedback =
      &measured_.try_emplace(number, none).first->second;
}

// Bullet has the wrench about the centre of mass, in the axes of its body frame.
Wrench SceneRobot::jointWrench(const std::string& joint) const {
  const int number = robot_.jointNumber(joint);
  const auto found = measured_.find(number);
  if (found == measured_.end())
    raiseInputError(robot_.model().source, "joint \"", joint, "\" is not measured");
  const btTransform& body = robot_.bodyTransform(number);
  const btSpatialForceVector& wrench = found->second.m_reactionForces;
  const Vector3 force = toVector3(body.getBasis() * wrench.m_topVec);
  const Vector3 arm = toVector3(body.getOrigin()) - robot_.linkPose(number).translation();
  return {toVector3(body.getBasis() * wrench.m_bottomVec) + arm.cross(force), force};
}

// Bullet has velocities in link frames.
MotionSample SceneRobot::sample(std::size_t link) const {
  const int number = static_cast<int>(link) - 1;
  const RigidPose pose = robot_.linkPose(number);
  const btMatrix3x3& to_W = robot_.bodyTransform(number).getBasis();
  robot_.multiBody().compTreeLinkVelocities(angular_.data(), linear_.data());
  MotionSample sample;
  sample.position = pose * robot_.model().links[link].centre_of_mass;
  sample.orientation = Quaternion(Matrix3(pose.linear()));
  sample.twist = {toVector3(to_W * angular_[link]), toVector3(to_W * linear_[link])};
  return sample;
}

}  // namespace ambient
