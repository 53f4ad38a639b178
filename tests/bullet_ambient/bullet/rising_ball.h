#pragma once

#include <gtest/gtest.h>

#include <string>

#include "bullet_ambient/fluid.h"
#include "tests/bullet_ambient/bullet/fluid_world.h"

namespace ambient::test {

/// A ball lighter than water, in no world.
struct RisingBall {
  /// Expects that a fluid moves it in a world, and takes it out again.
  void expectRiseIn(btDynamicsWorld& world, Fluid& fluid) {
    constexpr btScalar kStep = btScalar(1) / 60;
    std::string said;
    fluid.setReport([&](const std::string& sentence) { said = sentence; });
    world.setGravity({0, 0, -10});
    world.addRigidBody(&body);
    const Immersed ball = fluid.add(body, unitBallIn(water()));
    for (int i = 0; i < 10; ++i) world.stepSimulation(kStep, 0, kStep);
    EXPECT_GT(body.getLinearVelocity().z(), 0);
    EXPECT_GE(ball.counters().substeps, 10);
    EXPECT_EQ(said, "");
    EXPECT_TRUE(ball.remove());
    world.removeRigidBody(&body);
    body.setLinearVelocity({0, 0, 0});
  }

  btSphereShape shape{1};
  btRigidBody body{2500, nullptr, &shape, btVector3(1000, 1000, 1000)};
};

}  // namespace ambient::test
