// Velocities so small that Bullet would compute with subnormal numbers.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "tests/bullet_ambient/bullet/fluid_world.h"

namespace ambient::test {
namespace {

constexpr double kTinyStep = 1.0 / 60;
constexpr double kBallRadius = 0.1;

// Number with the smallest square that is not subnormal.
const double kTiny = std::sqrt(static_cast<double>(std::numeric_limits<btScalar>::min()));

bool isTiny(const btVector3& v) {
  for (int i = 0; i < 3; ++i)
    if (v[i] != 0 && static_cast<double>(btFabs(v[i])) < kTiny) return true;
  return false;
}
bool moves(const btVector3& v) { return !(v == btVector3(0, 0, 0)); }

FluidBody ball(double radius) {
  FluidBody shape = facelessEllipsoid(Vector3::Constant(radius));
  shape.sphere_radius = radius;
  return shape;
}

BodyDef ballOf(double mass, double radius) {
  return {mass, ellipsoidMoments(Vector3::Constant(radius), mass), {}, nullptr};
}

// Rounding of friction and pressure spins the ball by 1e-22 rad/s: its square is subnormal.
TEST(TinyVelocity, ABallThatFallsInWaterDoesNotSpinByRounding) {
  FluidWorld scene;
  scene.world.setGravity({0, bt(-9.81), 0});
  const btRigidBody& body = scene.add(ballOf(5, kBallRadius), ball(kBallRadius), water());
  for (int i = 0; i < 600; ++i) {
    scene.step(kTinyStep);
    ASSERT_FALSE(isTiny(body.getAngularVelocity())) << i;
    ASSERT_FALSE(isTiny(body.getLinearVelocity())) << i;
  }
  EXPECT_GT(body.getLinearVelocity().length(), 1);
}

TEST(TinyVelocity, BuoyancyBesideTheCentreOfMassByATraceTurnsNothing) {
  FluidWorld scene;
  scene.world.setGravity({0, bt(-9.81), 0});
  FluidBody shape = facelessEllipsoid(Vector3::Constant(kBallRadius));
  shape.centre_of_volume = {kTiny * 1e-6, 0, 2e-6 * kTiny};
  const btRigidBody& body = scene.add(ballOf(5, kBallRadius), shape, water());
  for (int i = 0; i < 600; ++i) {
    scene.step(kTinyStep);
    ASSERT_FALSE(moves(body.getAngularVelocity())) << i;
  }
}

TEST(TinyVelocity, ATorqueOfATraceDoesNotTurnABodyWithRows) {
  FluidWorld scene;
  btRigidBody& body = scene.add(ballOf(5, kBallRadius), ball(kBallRadius), water());
  btPoint2PointConstraint joint(body, btVector3(0, 0, 0));
  scene.world.addConstraint(&joint);
  for (int i = 0; i < 10; ++i) {
    body.applyTorque({bt(kTiny * 1e-6), 0, 0});
    scene.step(kTinyStep);
    EXPECT_FALSE(moves(body.getAngularVelocity())) << i;
  }
  scene.world.removeConstraint(&joint);
}

TEST(TinyVelocity, WhatCountsIsNotTouched) {
  FluidWorld scene;
  btRigidBody& body = scene.add(ballOf(5, kBallRadius), ball(kBallRadius), water());
  const double spin = 1e6 * kTiny;
  body.setAngularVelocity({bt(spin), 0, 0});
  scene.step(kTinyStep, 10);
  EXPECT_NEAR(static_cast<double>(body.getAngularVelocity().x()) / spin, 1, 1e-3);
}

// Newton's cradle in air: five steel balls side by side, the first released from 40 degrees.
TEST(TinyVelocity, NewtonsCradleHasNone) {
  constexpr double kBall = 0.05, kLength = 1, kAngle = 0.7;
  FluidWorld scene;
  scene.world.setGravity({0, bt(-9.81), 0});
  btSphereShape shape(bt(kBall));
  std::vector<btRigidBody*> balls;
  for (int i = 0; i < 5; ++i) {
    const double angle = i == 0 ? kAngle : 0;
    const Vector3 rod(std::sin(angle), std::cos(angle), 0);
    BodyDef def = ballOf(4, kBall);
    def.shape = &shape;
    def.start.position = Vector3(2 * kBall * i, 0, 0) - kLength * rod;
    balls.push_back(&scene.add(def, ball(kBall), air()));
    balls.back()->setRestitution(1);
    scene.contents.take(
        std::make_unique<btPoint2PointConstraint>(*balls.back(), toBullet(kLength * rod)));
  }
  for (int i = 0; i < 600; ++i) {
    scene.step(kTinyStep);
    for (const btRigidBody* body : balls) {
      ASSERT_FALSE(isTiny(body->getAngularVelocity())) << i;
      ASSERT_FALSE(isTiny(body->getLinearVelocity())) << i;
    }
  }
}

}  // namespace
}  // namespace ambient::test
