#pragma once

#include "preprocess/robot/robot_model.h"

namespace ambient {

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

}  // namespace ambient
