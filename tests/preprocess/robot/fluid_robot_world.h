#pragma once

#include "bullet_ambient/ambient.h"
#include "bullet_ambient/bullet/core/conversions.h"
#include "preprocess/robot/robot.h"
#include "tests/support/world.h"

namespace ambient {

/// A world for robots and its fluid.
struct FluidRobotWorld : test::TreeWorld {
  Fluid fluid{world};
};

/// A robot in a stock world for multibodies.
struct RobotWorld : test::TreeWorld {
  explicit RobotWorld(RobotModel model, const RobotSettings& settings = {},
                      const Vector3& gravity = {0, 0, 0})
      : robot(std::move(model), settings) {
    world.setGravity(toBullet(gravity));
    robot.addTo(world);
  }

  void step(double time_step, int count = 1) {
    for (int i = 0; i < count; ++i) {
      robot.prepareStep(time_step);
      world.stepSimulation(static_cast<btScalar>(time_step), 0);
    }
  }

  Robot robot;
};

/// Tolerance of rounding for btScalar: double or float.
inline double rounding() { return sizeof(btScalar) == 8 ? 1e-12 : 2e-5; }

}  // namespace ambient
