#pragma once

#include <BulletDynamics/Featherstone/btMultiBodyJointMotor.h>

#include <map>
#include <memory>
#include <vector>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "preprocess/robot/motor_target.h"

AMBIENT_BEGIN

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

AMBIENT_END
