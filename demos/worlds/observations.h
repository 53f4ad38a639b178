#pragma once

#include <optional>

#include "demos/worlds/batch_plan.h"

namespace ambient {

/// A world at the end of an env step, as observations see one of its bodies.
struct ObservationView {
  const BatchPlan& plan;
  Simulation& simulation;
  const double* parameters;
  const ObservationField* field = nullptr;
  Vector3 target{0, 0, 0};
  Vector3 place{0, 0, 0};  ///< of a sensor, from the centre of mass, axes of the shape [m]
  double time_share = 0;   ///< env steps made, over BatchSettings::most_steps; 0: no limit
  std::optional<Twist> before = {};  ///< for an imu: before the last substep, in W; none: a reset
  MotionSample now = {};
  Matrix3 to_W = Matrix3::Identity();  ///< axes of the body's shape to W
};

}  // namespace ambient
