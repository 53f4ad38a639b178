#pragma once

#include <memory>

#include "demos/analysis/motion_sample.h"
#include "demos/scene/scene.h"
#include "preprocess/robot/robot.h"

namespace ambient {

/// A robot of a scene in a world, and what its motors do over time.
class SceneRobot {
 public:
  /// @throws std::runtime_error as Robot
  explicit SceneRobot(const RobotDef& def);

  Robot& robot() { return robot_; }
  const Robot& robot() const { return robot_; }

  /// Before a step from `time` on [s].
  void prepareStep(double time, double time_step);

  /// Motion of a link of the model, in its own axes; the time is left open.
  MotionSample sample(std::size_t link) const;

 private:
  RobotDef def_;
  Robot robot_;
};

}  // namespace ambient
