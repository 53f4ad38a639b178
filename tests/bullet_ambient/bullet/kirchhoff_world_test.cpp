#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "bullet_ambient/base/pi.h"
#include "tests/bullet_ambient/bullet/fluid_world.h"
#include "tests/reference/kirchhoff_motion.h"
#include "tests/support/bodies/free_body.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/matrices.h"
#include "tests/support/rotations.h"

namespace ambient::test {
namespace {

// Exact solutions without loads by stepSimulation(): accurate at any step and any spin.

constexpr int kEllipsoids = 9;

// Adds a body; `start` has its twist in body axes here.
btRigidBody& addTo(FluidWorld& world, BodyDef def, const FluidBody& shape, double density) {
  const Quaternion& q = def.start.orientation;
  def.start.twist = {q * def.start.twist.angular, q * def.start.twist.linear};
  return world.add(def, shape, idealFluid(density));
}

// Adds a body of random coupled added mass, pose and spin axis.
btRigidBody& addCoupledBody(FluidWorld& world, unsigned seed, double spin) {
  Arbitrary arbitrary(seed);
  const Matrix6 added_mass = 0.3 * arbitrary.positiveDefinite();
  BodyDef def;
  def.moments = {arbitrary.between(0.5, 1), arbitrary.between(0.5, 1), arbitrary.between(0.5, 1)};
  def.start.orientation = Quaternion(arbitrary.rotation());
  def.start.twist = {spin * arbitrary.vector().normalized(),
                     0.1 * spin * arbitrary.vector().normalized()};
  return addTo(world, def, shapeWithoutFaces(added_mass, 0), 1);
}

// Duration [s] of at most 120 rad: longer motions are chaotic.
double durationOf(double spin) { return std::min(2.0, 120 / spin); }

// Pose after the duration by an independent integrator, from the state stored by Bullet.
reference::KirchhoffState exactEnd(const btRigidBody& body, const Matrix6& total, double spin) {
  const RigidState start = readState(body);
  const Eigen::Matrix<double, 6, 6> inertia = total;
  reference::KirchhoffState s;
  s << start.orientation.coeffs(), start.position, inertia * start.twist.vector();
  return reference::integrate({inverse(inertia)}, s, durationOf(spin),
                              std::max(60, static_cast<int>(spin * 20)));
}

// Sorted errors of the rotation after the duration.
std::vector<double> rotationErrors(double spin, double step) {
  std::vector<double> errors;
  for (unsigned seed = 0; seed < kEllipsoids; ++seed) {
    FluidWorld world;
    const btRigidBody& body = addCoupledBody(world, seed, spin);
    const auto end = exactEnd(body, world.of(body).inertia(), spin);
    world.step(step, static_cast<int>(std::lround(durationOf(spin) / step)));
    errors.push_back(angleBetween(readState(body).orientation, reference::orientationOf(end)));
  }
  std::sort(errors.begin(), errors.end());
  return errors;
}

struct SpinAccuracy {
  double spin;              // [rad/s]
  double float64, float32;  // median body [rad]
};

// The flow without loads is exact at any step. Measured: float64 5e-13, 5e-12 and 3e-11, rounding
// of 120 to 480 steps. float32 7e-6, 2e-5 and 6e-5: steps store velocities to 6e-8. 60 rad/s at 60
// Hz exceeds Bullet's limit of pi/4 per step.
constexpr SpinAccuracy kAccuracies[] = {
    {6, 1e-11, 5e-5}, {20, 1e-10, 1e-4}, {60, 1e-9, 5e-4}, {200, 1e-9, 5e-4}};

TEST(FreeFlight, FollowsKirchhoffsEquationsAtAnyStep) {
  for (const SpinAccuracy& accuracy : kAccuracies) {
    for (const double step : {1.0 / 60, 1.0 / 120, 1.0 / 240}) {
      const std::vector<double> errors = rotationErrors(accuracy.spin, step);
      EXPECT_LT(errors[kEllipsoids / 2], byPrecision(accuracy.float64, accuracy.float32))
          << accuracy.spin << " rad/s at " << step;
      // Motions amplify errors differently.
      EXPECT_LT(errors.back(), 10 * byPrecision(accuracy.float64, accuracy.float32))
          << accuracy.spin << " rad/s at " << step;
    }
  }
}

// Spin about the axis of least inertia: any error of the pose adds energy. Bullet turns bodies by
// the small remainder of full turns, with the rounding of the full spin.
TEST(FreeFlight, NeverGainsEnergyHoweverFarAStepTurns) {
  for (const double rounds : {2, 1600, 16000}) {
    const double turn = 2 * kPi * rounds + 0.4;  // 13, 1e4 and 1e5 rad
    FluidWorld world;
    BodyDef def;
    def.moments = {0.2, 0.8, 1};
    def.start.orientation = Quaternion(Arbitrary(1).rotation());
    def.start.twist.angular = {60 * turn, 0, 0};
    const btRigidBody& body = addTo(world, def, shapeWithoutFaces(Matrix6::Identity(), 0), 0.1);
    const Matrix6 K = world.of(body).inertia();
    const auto energy = [&] {
      const Vector6 x = readState(body).twist.vector();
      return x.dot(K * x);
    };
    const double start = energy();
    double most = start;
    for (int i = 0; i < 200; ++i) {
      world.step(1.0 / 60);
      most = std::max(most, energy());
    }
    EXPECT_LT(most / start - 1, byPrecision(1e-12, 3e-6)) << turn << " rad per step";
  }
}

TEST(FreeFlight, TurnsByAnyAngleInOneStep) {
  // Balls with 1, 5 and 50 rad per step.
  for (const double spin : {60.0, 300.0, 3000.0}) {
    FluidWorld world;
    const btRigidBody& body =
        addTo(world, {1, Vector3::Ones(), startWith({{0, 0, spin}, {1, 0, 0}})},
              shapeWithoutFaces(Matrix6::Identity(), 0), 1);
    constexpr double kStep = 1.0 / 64;
    constexpr int kSteps = 32;
    world.step(kStep, kSteps);
    const double angle = std::remainder(spin * kStep * kSteps, 2 * kPi);
    const Quaternion expected(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()));
    // float32 rounds the orientation in each step; float64 has 1e-9 at 1500 rad.
    EXPECT_LT(angleBetween(readState(body).orientation, expected), byPrecision(1e-9, 2e-5));
    EXPECT_NEAR(double(body.getWorldTransform().getOrigin().x()), kStep * kSteps,
                byPrecision(1e-10, 1e-6));
    EXPECT_NEAR(double(body.getAngularVelocity().z()), spin, spin * byPrecision(1e-12, 1e-5));
  }
}

// Velocities so small that Bullet would compute with subnormal numbers.

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
  scene.contents.take(std::make_unique<btPoint2PointConstraint>(body, btVector3(0, 0, 0)));
  for (int i = 0; i < 10; ++i) {
    body.applyTorque({bt(kTiny * 1e-6), 0, 0});
    scene.step(kTinyStep);
    EXPECT_FALSE(moves(body.getAngularVelocity())) << i;
  }
}

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

TEST(TinyVelocity, WhatCountsIsNotTouched) {
  FluidWorld scene;
  btRigidBody& body = scene.add(ballOf(5, kBallRadius), ball(kBallRadius), water());
  const double spin = 1e6 * kTiny;
  body.setAngularVelocity({bt(spin), 0, 0});
  scene.step(kTinyStep, 10);
  EXPECT_NEAR(static_cast<double>(body.getAngularVelocity().x()) / spin, 1, 1e-3);
}

}  // namespace
}  // namespace ambient::test
