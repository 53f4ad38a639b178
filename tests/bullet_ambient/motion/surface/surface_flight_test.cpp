#include "bullet_ambient/motion/surface/surface_flight.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bullet_ambient/motion/flight/flight.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/floating_runs.h"
#include "tests/support/refusal_of.h"

namespace ambient {
namespace {

using test::FloatingDef;
using test::FloatingRun;

FloatingDef ballDef(double gravity, double radius = 0.5) {
  FloatingDef def{test::floatingBall(radius)};
  def.gyration = Vector3::Constant(std::sqrt(0.4) * radius);
  def.gravity = gravity;
  return def;
}

TEST(SurfaceFlight, EntryWithoutGravityKeepsMomentum) {
  // Von Karman 1929: (m + K) v = m v_0. Froude number infinite, theta = 1.
  for (const double step : {0.1, 1 / 60.0, 1 / 240.0}) {
    FloatingRun ball(ballDef(0));
    ball.state.position = {0, 0, 0.55};
    ball.state.twist.linear = {0, 0, -2};
    ball.run(0.4, step);
    const double total = ball.inertia()(5, 5);
    EXPECT_GT(total, 1.3 * ball.mass());
    EXPECT_NEAR(ball.velocity_W().z(), -2 * ball.mass() / total, 1e-3 * 2) << step;
  }
}

TEST(SurfaceFlight, ExitWithoutGravityKeepsVelocity) {
  for (const double step : {0.05, 1 / 240.0}) {
    FloatingRun ball(ballDef(0));
    ball.state.position = {0, 0, -0.5};  // just covered
    ball.state.twist.linear = {0, 0, 2};
    ball.run(0.7, step);
    EXPECT_NEAR(ball.velocity_W().z(), 2, 2e-3) << step;
  }
}

TEST(SurfaceFlight, ObliqueEntryKeepsMomentumAndDoesNotSpin) {
  for (const double step : {1 / 50.0, 1 / 200.0}) {
    FloatingRun ball(ballDef(0));
    ball.state.position = {0, 0, 0.52};
    ball.state.twist.linear = {2, 0, -2};
    ball.run(0.4, step);
    const Vector3 start = 2 * ball.mass() * Vector3(1, 0, -1);
    EXPECT_LT((ball.momentum_W() - start).norm(), 5e-3 * start.norm()) << step;
    EXPECT_LT(ball.state.twist.angular.norm(), step);  // an error of first order
  }
}

TEST(SurfaceFlight, SpinningBallThatFloatsHasNoLift) {
  // Momentum turned with body axes would give a lift of 1.5 m/s^2. Drift alone pulls the ball down
  // by T_h / (rho g A_w), 2 cm, about which the ball swings.
  FloatingDef def = ballDef(9.81);
  def.shape = test::floatingEllipsoid(Vector3::Constant(0.5), 3);
  FloatingRun ball(def), without_spin(def);
  ball.state.twist = {{0, 3, 0}, {1, 0, 0}};
  without_spin.state.twist = {{0, 0, 0}, {1, 0, 0}};
  ball.run(1, 1 / 240.0);
  without_spin.run(1, 1 / 240.0);
  EXPECT_LT((ball.velocity_W() - without_spin.velocity_W()).norm(), 0.02);
  EXPECT_LT((ball.state.position - without_spin.state.position).norm(), 0.01);
  EXPECT_NEAR(ball.state.position.z(), -0.01, 0.015);
}

TEST(SurfaceFlight, HorizontalMomentumAndVerticalSpinStay) {
  FloatingDef def{test::floatingEllipsoid({0.5, 0.4, 0.3}, 2)};
  FloatingRun body(def);
  body.state.position = {0, 0, 0.6};
  body.state.orientation = Quaternion(0.9, 0.3, -0.2, 0.1).normalized();
  body.state.twist = {{0.5, -0.3, 1}, {1, 0.5, 0}};
  const Vector3 before = body.momentum_W();
  body.run(1, 1 / 480.0);
  const Vector3 after = body.momentum_W();
  EXPECT_NEAR(after.x(), before.x(), 0.02 * before.norm());
  EXPECT_NEAR(after.y(), before.y(), 0.02 * before.norm());
}

TEST(SurfaceFlight, EnergyNeverGrows) {
  test::Arbitrary arbitrary(1);
  const std::vector<FluidBody> shapes{test::floatingEllipsoid({0.5, 0.4, 0.3}, 1),
                                      test::floatingBall(0.5, 1),
                                      test::floatingBox({1, 0.8, 0.5}, 1)};
  for (int i = 0; i < 60; ++i) {
    const double size = std::pow(10, arbitrary.between(-2, 1));
    FloatingDef def{scaled(shapes[static_cast<std::size_t>(i) % 3], size)};
    def.gyration *= size;
    def.specific_gravity = std::pow(10, arbitrary.between(-1.7, 1.3));
    def.has_loads = i % 2 == 0;
    FloatingRun body(def);
    const double speed = std::sqrt(9.81 * size);
    body.state.position = {0, 0, arbitrary.between(-1, 1.5) * size};
    body.state.orientation = Quaternion(arbitrary.rotation());
    body.state.twist = arbitrary.twist(speed / size, speed);
    const double step = std::pow(2, -arbitrary.between(5, 10));
    const double scale = (body.mass() + test::kWaterDensity * def.shape.volume) * 9.81 * size;
    double energy = body.energy();
    for (int n = 0; n < 60; ++n) {
      body.step(step);
      ASSERT_TRUE(body.state.isFinite()) << i;
      const double now = body.energy();
      ASSERT_LE(now - energy, 1e-12 * (scale + std::abs(now)))
          << "run " << i << ", step " << n << " of " << step << " s, size " << size
          << ", specific gravity " << def.specific_gravity;
      energy = now;
    }
  }
}

/// Chip of 1.3 cm, 0.035 times as heavy as water. Within a step of 0.022 s it would reach a depth
/// that needs more than all its energy.
FloatingRun chipAt(double height) {
  FloatingDef def{test::floatingEllipsoid({0.0065, 0.0013, 0.00065}, 1)};
  def.gyration = Vector3::Constant(0.005);
  def.specific_gravity = 0.035;
  FloatingRun body(def);
  body.state.position = {0, 0, height};
  body.state.twist = {{2, 5, -6}, {0, 0, -0.5}};
  return body;
}

TEST(SurfaceFlight, LightBodyDoesNotFallDeeperThanItsEnergyReaches) {
  for (const double height : {0.02, 0.03, 0.04}) {
    FloatingRun body = chipAt(height);
    const double scale = test::kWaterDensity * body.model().shape->volume * 9.81 * 0.013;
    double energy = body.energy();
    for (int n = 0; n < 30; ++n) {
      body.step(0.022);
      EXPECT_LE(body.energy() - energy, 1e-11 * scale) << "step " << n;
      energy = body.energy();
    }
  }
}

// Two substeps are too few. The chip keeps the motion after the first one if allowed; else it comes
// to rest and loses all its motion.
TEST(SurfaceFlight, HaltsAfterTheLastSubstepThatItsEnergyReaches) {
  FloatingRun body = chipAt(0.03);
  body.settings.max_substeps = 2;
  int stopped = 0, rested = 0;
  for (int n = 0; n < 30; ++n) {
    const Vector3 from = body.state.position;
    const double before = body.energy();
    body.step(0.025);
    EXPECT_LE(body.energy(), before * (1 + 1e-12)) << n;
    if (!body.count.halted) continue;
    EXPECT_TRUE(body.count.coarse);
    EXPECT_EQ(body.count.error, 1);
    if (body.state.position != from) {
      EXPECT_GT(body.velocity_W().norm(), 0.1);
      ++stopped;
    } else {
      EXPECT_EQ(body.state.twist.vector(), Vector6(Vector6::Zero()));
      EXPECT_NEAR(body.count.energy_removed, before - body.energy(), 1e-12 * before);
      ++rested;
    }
  }
  EXPECT_EQ(stopped, 1);
  EXPECT_EQ(rested, 2);
}

// Small, light bodies at long steps: with two retries only, 26 of these 1000 steps end at rest.
TEST(SurfaceFlight, TakesAllSubstepsBeforeItRests) {
  test::Arbitrary arbitrary(4);
  const FluidBody shape = test::floatingEllipsoid({0.5, 0.4, 0.3}, 1);
  int resting = 0, halted = 0;
  for (int i = 0; i < 100; ++i) {
    const double size = std::pow(10, arbitrary.between(-2.5, -1));
    FloatingDef def{scaled(shape, size)};
    def.gyration *= size;
    def.specific_gravity = std::pow(10, arbitrary.between(-2, -1));
    FloatingRun body(def);
    const double speed = 3 * std::sqrt(9.81 * size);
    body.state.position = {0, 0, arbitrary.between(-1, 1.5) * size};
    body.state.orientation = Quaternion(arbitrary.rotation());
    body.state.twist = arbitrary.twist(speed / size, speed);
    for (int n = 0; n < 10; ++n) {
      body.step(1.0 / 15);
      resting += body.state.twist.vector().isZero(0);
      halted += body.count.halted;
    }
  }
  EXPECT_EQ(resting, 0);
  EXPECT_EQ(halted, 0);
}

TEST(SurfaceFlight, BodyThatFloatsStaysWhereItIs) {
  FloatingDef def{test::floatingBox({1, 0.8, 0.5})};
  def.has_loads = true;
  FloatingRun box(def);
  box.run(2, 1 / 60.0);
  EXPECT_LT(box.state.position.norm(), 1e-9);
  EXPECT_LT(box.state.twist.vector().norm(), 1e-9);
}

TEST(SurfaceFlight, MovesWithAStreamOfWater) {
  FloatingDef def{test::floatingEllipsoid({0.5, 0.4, 0.3}, 2)};
  def.has_loads = true;
  FloatingRun still(def), carried(def);
  const Vector3 stream(0.7, -0.4, 0);
  still.state.position = carried.state.position = {0, 0, 0.3};
  still.state.twist = {{0.2, 0.1, 0}, {1, 0, -1}};
  carried.state.twist = still.state.twist;
  carried.state.twist.linear += stream;
  carried.surroundings().ambient_velocity = stream;
  still.run(0.5, 0.01);
  carried.run(0.5, 0.01);
  EXPECT_LT((carried.state.position - still.state.position - 0.5 * stream).norm(), 1e-9);
  EXPECT_LT((carried.velocity_W() - still.velocity_W() - stream).norm(), 1e-9);
}

TEST(SurfaceFlight, WindPushesWhatIsOutOfTheWater) {
  FloatingDef def{test::floatingBox({1, 0.8, 0.5})};
  def.has_loads = true;
  def.above = air();
  def.above.velocity = {10, 0, 0};
  FloatingRun box(def);
  box.velocity_above = def.above.velocity;
  box.step(0.01);
  const double push = box.state.twist.linear.x();
  // Wind acts on half of the side; its front has the stagnation pressure of the slip. Bounds: 0 and
  // rho v^2 A.
  EXPECT_GT(push, 0);
  EXPECT_LT(push, 0.01 * 1.204 * 100 * 0.8 * 0.25 / box.mass());
}

TEST(SurfaceModel, KnowsOnWhichSideOfTheSurfaceABodyIs) {
  FloatingDef def{test::floatingBox({1, 0.8, 0.5})};
  const FloatingRun box(def);
  const auto sideAt = [&](double height, double travel) {
    return sideOf(box.model(), {{0, 0, 1}, height, 0, 0}, travel);
  };
  EXPECT_EQ(sideAt(-100, 0), SurfaceSide::kAbove);
  EXPECT_EQ(sideAt(-0.26, 0), SurfaceSide::kAbove);
  EXPECT_EQ(sideAt(-0.26, 0.02), SurfaceSide::kAt);
  EXPECT_EQ(sideAt(0, 0), SurfaceSide::kAt);
  EXPECT_EQ(sideAt(1.24, 0), SurfaceSide::kAt);
  EXPECT_EQ(sideAt(1.26, 0), SurfaceSide::kBelow);
  EXPECT_EQ(sideAt(1.26, 0.1), SurfaceSide::kAt);
  EXPECT_EQ(sideAt(100, 0), SurfaceSide::kBelow);
}

TEST(SurfaceModel, RefusesWhatCannotFloat) {
  SurfaceModelDef def;
  FluidBody body = test::floatingBox({1, 1, 1});
  const auto refusal = [&] {
    def.shape = std::make_shared<const FluidBody>(body);
    return test::refusalOf<std::invalid_argument>([&] { makeSurfaceModel(def); });
  };
  def.mass = {1, Matrix3::Identity()};
  def.below = water();
  EXPECT_EQ(refusal(), "");
  def.above = {2000, 0, {0, 0, 0}, {0, 0, 0}};
  EXPECT_EQ(refusal(),
            "fluid body 'hull': density of the fluid above it [kg/m^3] is 2000, must be at most "
            "that of the fluid below");
  def.above = air();
  body.surface = {};
  EXPECT_EQ(refusal(),
            "fluid body 'hull': number of triangles of its surface is 0, must be positive for a "
            "body that may float");
}

}  // namespace
}  // namespace ambient
