#pragma once

#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>

#include "preprocess/robot/robot.h"

namespace ambient {

/// A stock world for multibodies.
struct RobotWorld {
  explicit RobotWorld(const Vector3& gravity = {0, 0, 0}) {
    world.setGravity(toBulletVector(gravity));
  }

  void step(Robot& robot, double time_step, int count = 1) {
    for (int i = 0; i < count; ++i) {
      robot.prepareStep(time_step);
      world.stepSimulation(static_cast<btScalar>(time_step), 0);
    }
  }

  static btVector3 toBulletVector(const Vector3& v) {
    return {static_cast<btScalar>(v.x()), static_cast<btScalar>(v.y()),
            static_cast<btScalar>(v.z())};
  }

  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btMultiBodyConstraintSolver solver;
  btMultiBodyDynamicsWorld world{&dispatcher, &broadphase, &solver, &configuration};
};

/// Tolerance of rounding for btScalar: double or float.
inline double rounding() { return sizeof(btScalar) == 8 ? 1e-12 : 2e-5; }

}  // namespace ambient
