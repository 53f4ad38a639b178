#include <gtest/gtest.h>

#include <cmath>

#include "tests/bullet_ambient/bullet/worlds/coupled_scene.h"

// Bullet's features for a body of coupled K: kinematic bodies, locked axes, compound shapes,
// filters, continuous collision, forces at points and damping.
namespace ambient::test {
namespace {

reference::DenseBody fixedBody() {
  reference::DenseBody result;
  result.fixed = true;
  return result;
}

TEST(ContactFeatures, AKinematicBodyPushesWithItsVelocity) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    CoupledScene scene(seed);
    scene.stop();
    const double speed = 1.5, half = 0.1;
    btTransform pose = scene.body().getWorldTransform();
    pose.setOrigin({bt(half + CoupledScene::kRadius - 1e-3), 0, 0});
    scene.body().setCenterOfMassTransform(pose);
    btBoxShape box(btVector3(bt(half), 1, 1));
    btRigidBody paddle(0, nullptr, &box);
    paddle.setFriction(0);
    paddle.setCollisionFlags(paddle.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
    paddle.setActivationState(DISABLE_DEACTIVATION);
    scene.scene.world.addRigidBody(&paddle);
    const double dt = 1.0 / 128;
    paddle.setWorldTransform(
        btTransform(btQuaternion::getIdentity(), btVector3(bt(speed * dt), 0, 0)));
    const Vector3r x(1, 0, 0);
    reference::DenseRow row = reference::pointRow(x, -Real(CoupledScene::kRadius) * x, x);
    row.target = speed;
    row.lower = 0;
    const auto expected = reference::solveDense({scene.coupled.dense(dt), fixedBody()}, {row});
    scene.solve(dt);
    EXPECT_GT(expected.velocities[0].norm(), 1.4);
    EXPECT_LT(scene.coupled.error(expected.velocities[0], expected.velocities[0]), kTolerance);
    scene.scene.world.removeRigidBody(&paddle);
  }
}

TEST(ContactFeatures, ABodyLockedToAPlaneStaysInIt) {
  FluidWorld scene;
  scene.world.setGravity({0, bt(-9.81), 0});
  btStaticPlaneShape plane({0, 1, 0}, -1);
  scene.contents.add(0, plane);
  btBoxShape box({bt(0.3), bt(0.2), bt(0.1)});
  BodyDef def{30, Vector3(0.5, 1, 1.3), {}, &box};
  def.start.twist = {Vector3(0, 0, 2), Vector3(1, 0, 0)};
  btRigidBody& body = scene.add(def);
  body.setAngularFactor(btVector3(0, 0, 1));
  body.setLinearFactor(btVector3(1, 1, 0));
  AttachDef attach;
  attach.fluid_body = std::make_shared<FluidBody>(meshedEllipsoid({0.3, 0.2, 0.1}, 1));
  attach.medium = water();
  attach.fluid_frame.translation = Vector3(0.02, -0.01, 0.03);  // out of the plane
  scene.fluid.add(body, attach);
  for (int i = 0; i < 600; ++i) {
    scene.step(1.0 / 120);
    EXPECT_EQ(body.getWorldTransform().getOrigin().z(), 0);
    EXPECT_EQ(body.getLinearVelocity().z(), 0);
    EXPECT_EQ(body.getAngularVelocity().x(), 0);
    EXPECT_EQ(body.getAngularVelocity().y(), 0);
  }
  EXPECT_GT(scene.of(body).counters().rows, 0);
  const btVector3 z = body.getWorldTransform().getBasis().getColumn(2);
  EXPECT_NEAR(static_cast<double>(z.z()), 1, byPrecision(1e-15, 1e-6));
}

// Speed of a ball that moves along y only, pushed out of an overlapping wall. The wall's normal is
// at an angle to the locked x; Bullet pushes along the normal.
double speedOfPush(double angle, bool in_fluid) {
  constexpr double kDepth = 1e-3;
  FluidWorld scene;
  scene.world.getSolverInfo().m_splitImpulse = 0;
  btStaticPlaneShape plane({bt(std::cos(angle)), bt(std::sin(angle)), 0}, 0);
  scene.contents.add(0, plane).setFriction(0);
  btSphereShape ball(bt(0.2));
  BodyDef def{1, Vector3::Constant(0.016), {}, &ball};
  def.start.position = (0.2 - kDepth) * Vector3(std::cos(angle), std::sin(angle), 0);
  Vector6 added;
  added << 0.01, 0.02, 0.03, 1, 2, 3;
  FluidBody shape;
  shape.name = "uneven";
  shape.added_mass = added.asDiagonal();
  btRigidBody& body = in_fluid ? scene.add(def, shape, idealFluid(1)) : scene.add(def);
  body.setLinearFactor({0, 1, 0});
  body.setAngularFactor(0);
  scene.step(kWorldStep);
  EXPECT_EQ(scene.fluid.counters().rows > 0, in_fluid);
  return static_cast<double>(body.getLinearVelocity().y());
}

// The normal's part along the free axis is a small lever. In float its square, 1e-4 of the whole,
// has three digits.
TEST(ContactFeatures, AContactAlmostAlongALockedAxisPushesAsInStockBullet) {
  for (const double angle : {1.5, 0.5, 0.1, 0.01}) {
    const double stock = speedOfPush(angle, false);
    EXPECT_GT(stock, 0) << angle;
    EXPECT_NEAR(speedOfPush(angle, true) / stock, 1, byPrecision(1e-9, 1e-3)) << angle;
  }
}

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

TEST(ContactFeatures, FiltersLetABodyThroughOrNot) {
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
  scene.body().setAngularVelocity(btVector3(1, 2, 3) * bt(seed % 2 == 0 ? 1 : 50));
  scene.body().setLinearVelocity({bt(speed), 0, 0});
  btTransform pose = scene.body().getWorldTransform();
  pose.setOrigin({0, 0, 0});
  scene.body().setWorldTransform(pose);
  btBoxShape box(btVector3(bt(0.05), 50, 50));
  scene.scene.contents.add(
      0, box, btTransform(btQuaternion::getIdentity(), btVector3(bt(kWallSurface + 0.05), 0, 0)));
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
  return farthest;
}

TEST(ContactFeatures, ContinuousCollisionStopsAtTheWall) {
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

TEST(ContactFeatures, DampingScalesTheVelocityBeforeEachStep) {
  const double dt = 1.0 / 128;
  CoupledScene damped(4), scaled(4);
  damped.body().setDamping(bt(0.3), bt(0.5));
  for (int i = 0; i < 128; ++i) {
    btRigidBody& body = scaled.body();
    body.setLinearVelocity(body.getLinearVelocity() * btPow(bt(0.7), bt(dt)));
    body.setAngularVelocity(body.getAngularVelocity() * btPow(bt(0.5), bt(dt)));
    damped.scene.step(dt);
    scaled.scene.step(dt);
  }
  const DenseVector6 expected = scaled.coupled.velocity();
  EXPECT_LT(damped.coupled.error(expected, expected), byPrecision(1e-12, 1e-4));
  EXPECT_LT(expected.norm(), 0.8 * CoupledScene(4).coupled.velocity().norm());
}

}  // namespace
}  // namespace ambient::test
