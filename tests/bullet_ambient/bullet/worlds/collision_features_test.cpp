#include <gtest/gtest.h>

#include <algorithm>

#include "tests/bullet_ambient/bullet/worlds/coupled_scene.h"

// Collisions of a body with coupled K: filters and continuous collision.
namespace ambient::test {
namespace {

// Position and velocity after half a second of flight towards a wall.
Vector6 flightTowardsAWall(bool is_wall_there, int mask) {
  CoupledScene scene(3);
  scene.body().setLinearVelocity({4, 0, 0});
  btTransform pose = scene.body().getWorldTransform();
  pose.setOrigin({0, 0, 0});
  scene.body().setWorldTransform(pose);
  scene.scene.world.removeRigidBody(&scene.body());
  scene.scene.world.addRigidBody(&scene.body(), 2, mask);
  btBoxShape box(btVector3(bt(0.1), 5, 5));
  btRigidBody wall(0, nullptr, &box);
  wall.setWorldTransform(btTransform(btQuaternion::getIdentity(), btVector3(1, 0, 0)));
  if (is_wall_there) scene.scene.world.addRigidBody(&wall, 4, -1);
  scene.scene.step(1.0 / 120, 60);
  const Vector6 state = stack(toVector3(scene.body().getWorldTransform().getOrigin()),
                              toVector3(scene.body().getLinearVelocity()));
  if (is_wall_there) scene.scene.world.removeRigidBody(&wall);
  return state;
}

TEST(CollisionFeatures, FiltersLetABodyThroughOrNot) {
  const Vector6 free = flightTowardsAWall(false, -1);
  EXPECT_GT(free[0], 1.2);
  EXPECT_EQ(flightTowardsAWall(true, -1 & ~4), free);
  EXPECT_LT(flightTowardsAWall(true, -1)[0], 1 - 0.1 - CoupledScene::kRadius + 0.01);
}

constexpr double kSweptRadius = 0.2, kCcdThreshold = 0.1;
constexpr double kWallSurface = 3.45;

// Farthest place of a body that flies towards a thin wall by more than its size per step.
double flyFast(unsigned seed, double speed, bool is_continuous) {
  CoupledScene scene(seed);
  btContactSolverInfo& info = scene.scene.world.getSolverInfo();
  info.m_erp = info.m_erp2 = bt(0.2);
  scene.body().setAngularVelocity({1, 2, 3});
  scene.body().setLinearVelocity({bt(speed), 0, 0});
  btTransform pose = scene.body().getWorldTransform();
  pose.setOrigin({0, 0, 0});
  scene.body().setWorldTransform(pose);
  btBoxShape box(btVector3(bt(0.05), 50, 50));
  btRigidBody wall(0, nullptr, &box);
  wall.setWorldTransform(
      btTransform(btQuaternion::getIdentity(), btVector3(bt(kWallSurface + 0.05), 0, 0)));
  scene.scene.world.addRigidBody(&wall);
  if (is_continuous) {
    scene.body().setCcdMotionThreshold(bt(kCcdThreshold));
    scene.body().setCcdSweptSphereRadius(bt(kSweptRadius));
  }
  double farthest = 0;
  for (int i = 0; i < 30; ++i) {
    scene.scene.step(1.0 / 60);
    farthest =
        std::max(farthest, static_cast<double>(scene.body().getWorldTransform().getOrigin().x()));
  }
  scene.scene.world.removeRigidBody(&wall);
  return farthest;
}

TEST(CollisionFeatures, ContinuousCollisionStopsAtTheWall) {
  for (const double speed : {60.0, 120.0}) {
    int tunnelled = 0;
    for (unsigned seed = 0; seed < 10; ++seed) {
      const double farthest = flyFast(seed, speed, true);
      EXPECT_GT(farthest, kWallSurface - CoupledScene::kRadius - 1e-3) << seed;
      // Motion below the threshold is not swept.
      EXPECT_LT(farthest, kWallSurface - kSweptRadius + kCcdThreshold) << seed;
      tunnelled += flyFast(seed, speed, false) > kWallSurface + 1;
    }
    EXPECT_GT(tunnelled, 3) << speed;
  }
}

}  // namespace
}  // namespace ambient::test
