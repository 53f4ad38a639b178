#include "preprocess/robot/robot_joints.h"

#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyGearConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointLimitConstraint.h>

#include <algorithm>
#include <cmath>

AMBIENT_BEGIN
namespace {

/// Share of the error of a mimic that a step takes back.
constexpr btScalar kMimicErp = btScalar(0.2);

btScalar boundedImpulse(double impulse) {
  return static_cast<btScalar>(std::min(impulse, static_cast<double>(BT_LARGE_FLOAT)));
}

}  // namespace

RobotJoints::RobotJoints(const RobotModel& model, btMultiBody& body) : model_(model), body_(body) {
  for (int number = 0; number < body.getNumLinks(); ++number) {
    const JointModel& of = joint(number);
    if (!of.isAxial()) continue;
    if (std::isfinite(of.lower)) makeLimit(number, of);
    if (of.mimic) makeMimic(number, *of.mimic);
    if (of.friction > 0 || of.damping > 0) brakes_[number] = makeMotor(number);
  }
}

void RobotJoints::makeLimit(int number, const JointModel& of) {
  passive_.push_back(std::make_unique<btMultiBodyJointLimitConstraint>(
      &body_, number, static_cast<btScalar>(of.lower), static_cast<btScalar>(of.upper)));
  passive_.back()->setMaxAppliedImpulse(BT_LARGE_FLOAT);
  passive_.back()->finalizeMultiDof();
}

void RobotJoints::makeMimic(int number, const JointModel::Mimic& mimic) {
  const int leader = model_.jointIndex(mimic.joint) - 1;
  const btVector3 none(0, 0, 0);
  const btMatrix3x3 axes = btMatrix3x3::getIdentity();
  auto gear = std::make_unique<btMultiBodyGearConstraint>(&body_, number, &body_, leader, none,
                                                          none, axes, axes);
  gear->setGearRatio(static_cast<btScalar>(-mimic.multiplier));
  gear->setRelativePositionTarget(static_cast<btScalar>(mimic.offset));
  gear->setErp(kMimicErp);
  gear->setMaxAppliedImpulse(BT_LARGE_FLOAT);
  gear->finalizeMultiDof();
  passive_.push_back(std::move(gear));
}

std::unique_ptr<btMultiBodyJointMotor> RobotJoints::makeMotor(int number) {
  auto motor = std::make_unique<btMultiBodyJointMotor>(&body_, number, btScalar(0), btScalar(0));
  motor->finalizeMultiDof();
  return motor;
}

const JointModel& RobotJoints::joint(int number) const {
  return model_.links[static_cast<std::size_t>(number) + 1].joint;
}

std::vector<btMultiBodyConstraint*> RobotJoints::all() const {
  std::vector<btMultiBodyConstraint*> constraints;
  for (const auto& constraint : passive_) constraints.push_back(constraint.get());
  for (const auto& [number, brake] : brakes_) constraints.push_back(brake.get());
  for (const auto& [number, motor] : motors_) constraints.push_back(motor.constraint.get());
  return constraints;
}

void RobotJoints::addTo(btMultiBodyDynamicsWorld& world) {
  world_ = &world;
  for (btMultiBodyConstraint* constraint : all()) world.addMultiBodyConstraint(constraint);
}

void RobotJoints::leaveWorld() {
  if (!world_) return;
  for (btMultiBodyConstraint* constraint : all()) world_->removeMultiBodyConstraint(constraint);
  world_ = nullptr;
}

void RobotJoints::setMotor(int number, const MotorTarget& target) {
  Motor& motor = motors_[number];
  if (!motor.constraint) {
    motor.constraint = makeMotor(number);
    if (world_) world_->addMultiBodyConstraint(motor.constraint.get());
  }
  const JointModel& of = joint(number);
  motor.effort = std::min(target.effort, of.effort);
  motor.constraint->setPositionTarget(static_cast<btScalar>(target.position),
                                      static_cast<btScalar>(target.position_gain));
  motor.constraint->setVelocityTarget(static_cast<btScalar>(target.velocity),
                                      static_cast<btScalar>(target.velocity_gain));
  motor.constraint->setRhsClamp(boundedImpulse(of.velocity));
}

// A motor without effort has no row, and keeps the impulse of the last row that it had.
double RobotJoints::motorEffort(int number) const {
  const auto motor = motors_.find(number);
  if (motor == motors_.end() || !(motor->second.effort > 0) || time_step_ == 0) return 0;
  return static_cast<double>(motor->second.constraint->getAppliedImpulse(0)) / time_step_;
}

void RobotJoints::prepareStep(double time_step) {
  time_step_ = time_step;
  for (const auto& [number, brake] : brakes_) {
    const double speed = std::abs(static_cast<double>(body_.getJointVel(number)));
    const JointModel& of = joint(number);
    brake->setMaxAppliedImpulse(boundedImpulse((of.friction + of.damping * speed) * time_step));
  }
  for (auto& [number, motor] : motors_)
    motor.constraint->setMaxAppliedImpulse(boundedImpulse(motor.effort * time_step));
}

AMBIENT_END
