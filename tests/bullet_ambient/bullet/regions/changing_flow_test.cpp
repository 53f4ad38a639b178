#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/saved_state.h"
#include "tests/bullet_ambient/bullet/regions/region_world.h"
#include "tests/bullet_ambient/bullet/state/state_scene.h"
#include "tests/support/bodies/part_bodies.h"

// Fluids whose velocity changes from step to step, without an acceleration: docs/theory.md eq.
// (19a).
namespace ambient::test {
namespace {

constexpr double kFlowStep = 1.0 / 60, kFlowPeriod = 4;  // [s]
constexpr int kFlowSteps = 240;                          // one period

Vector3 toAndFro(double time) { return {0.5 * std::sin(2 * kPi * time / kFlowPeriod), 0, 0}; }

Medium flowingWater(const Vector3& velocity) {
  Medium medium = idealFluid(1000);
  medium.velocity = velocity;
  return medium;
}

// A ball of 0.2 m without faces that has the density of flowingWater().
btRigidBody& addNeutralBall(FluidWorld& scene, const Medium& medium, double height = 0) {
  const FluidBody shape = facelessEllipsoid(Vector3::Constant(0.2));
  const double mass = 1000 * shape.volume;
  return scene.add({mass, ellipsoidMoments(Vector3::Constant(0.2), mass), startAt({0, 0, height})},
                   shape, medium);
}

// Speeds that are the rounding of those of the fluid, some m/s [m/s].
const double kFlowRounding = byPrecision(1e-12, 1e-5);

double speedLeft(const btRigidBody& body) {
  return static_cast<double>(body.getLinearVelocity().length());
}

double placeOf(const btRigidBody& body) {
  return static_cast<double>(body.getWorldTransform().getOrigin().x());
}

// The way to and fro of a body in a period, while `change` is called before each step with the
// time.
double wayOf(FluidWorld& scene, const btRigidBody& body,
             const std::function<void(double)>& change) {
  double least = 0, most = 0;
  for (int i = 0; i < kFlowSteps; ++i) {
    change(i * kFlowStep);
    scene.step(kFlowStep);
    least = std::min(least, placeOf(body));
    most = std::max(most, placeOf(body));
  }
  return most - least;
}

constexpr double kWayOfWater = 0.5 * kFlowPeriod / kPi;  // 0.637 m
const double kWayError = byPrecision(1e-4, 1e-4) * kWayOfWater;

// By a region that is set anew, a body's own medium, a function of time, and one of a variable.
TEST(ChangingFlow, CarriesABodyHoweverItIsGiven) {
  for (const char* how : {"region", "own", "time", "variable"}) {
    const std::string given = how;
    FluidWorld scene;
    Vector3 now = toAndFro(0);
    FluidRegion sea = filledWith(flowingWater(given == "region" ? now : Vector3(0, 0, 0)));
    if (given == "time")
      sea.flow = [](const Vector3&, double time) { return FlowSample{toAndFro(time), {0, 0, 0}}; };
    if (given == "variable")
      sea.flow = [&now](const Vector3&, double) { return FlowSample{now, {0, 0, 0}}; };
    const bool is_own = given == "own";
    if (!is_own) scene.fluid.addRegion(sea);
    const btRigidBody& body = addNeutralBall(scene, is_own ? flowingWater(now) : Medium{});
    const double way = wayOf(scene, body, [&](double time) {
      now = toAndFro(time);
      if (is_own) scene.of(body).setMedium(flowingWater(now));
      if (given == "region") scene.fluid.setRegion(RegionId{0}, filledWith(flowingWater(now)));
    });
    EXPECT_NEAR(way, kWayOfWater, kWayError) << given;
    // Read as it was given for the last step.
    EXPECT_LT((scene.of(body).medium().velocity - toAndFro((kFlowSteps - 1) * kFlowStep)).norm(),
              byPrecision(1e-12, 1e-6));
  }
}

// An acceleration that is given counts, and that alone.
TEST(ChangingFlow, ThatTellsItsAccelerationIsTakenAtItsWord) {
  FluidWorld scene;
  Medium medium = flowingWater({0, 0, 0});
  medium.acceleration = {0, 0.25, 0};
  const RegionId id = scene.fluid.addRegion(filledWith(medium));
  const btRigidBody& body = addNeutralBall(scene, Medium{});
  for (int i = 0; i < 60; ++i) {
    medium.velocity = Vector3(0.1, 0.25, 0) * (i * kFlowStep);
    scene.fluid.setRegion(id, filledWith(medium));
    scene.step(kFlowStep);
  }
  EXPECT_NEAR(static_cast<double>(body.getLinearVelocity().x()), 0, kFlowRounding);
  EXPECT_NEAR(static_cast<double>(body.getLinearVelocity().y()), 0.25, byPrecision(1e-12, 1e-5));
}

// Two balls on a joint, which rows move.
TEST(ChangingFlow, CarriesBodiesOnAJoint) {
  FluidWorld scene;
  const RegionId id = scene.fluid.addRegion(filledWith(flowingWater(toAndFro(0))));
  btRigidBody& a = addNeutralBall(scene, Medium{});
  btRigidBody& b = addNeutralBall(scene, Medium{}, 1);
  btPoint2PointConstraint joint(a, b, {0, 0, bt(0.5)}, {0, 0, bt(-0.5)});
  scene.world.addConstraint(&joint);
  const double way = wayOf(scene, a, [&](double time) {
    scene.fluid.setRegion(id, filledWith(flowingWater(toAndFro(time))));
  });
  EXPECT_NEAR(way, kWayOfWater, 1e-2 * kWayOfWater);
  EXPECT_GT(scene.fluid.counters().joint_rows, 0);
  scene.world.removeConstraint(&joint);
}

// A body of half the density in a half space of water is pushed by (m_f + m_a) / (m + m_a) = 3/2.
TEST(ChangingFlow, PushesWithDisplacedAndAddedMass) {
  FluidWorld scene;
  const RegionId id = scene.fluid.addRegion(filledWith(flowingWater({0, 0, 0})));
  const FluidBody shape = facelessEllipsoid(Vector3::Constant(0.2));
  const double mass = 500 * shape.volume;
  const btRigidBody& body = scene.add(
      {mass, ellipsoidMoments(Vector3::Constant(0.2), mass), {}, nullptr}, shape, Medium{});
  scene.step(kFlowStep);
  scene.fluid.setRegion(id, filledWith(flowingWater({0.2, 0, 0})));
  scene.step(kFlowStep, 3);
  EXPECT_NEAR(static_cast<double>(body.getLinearVelocity().x()), 1.5 * 0.2,
              byPrecision(1e-12, 1e-6));
}

TEST(ChangingFlow, DoesNotPushABodyThatHasNotSeenItsPast) {
  FluidWorld scene;
  const RegionId left = scene.fluid.addRegion(halfSpace(0, -kFar, flowingWater({0, 1, 0})));
  FluidRegion right = halfSpace(0, 5, flowingWater({0, 0, 2}));
  scene.fluid.addRegion(right);
  btRigidBody& body = addNeutralBall(scene, Medium{});
  scene.fluid.setRegion(left, halfSpace(0, -kFar, flowingWater({0, 3, 0})));
  scene.step(kFlowStep, 2);  // the first step after it was added
  EXPECT_LT(speedLeft(body), kFlowRounding);
  body.getWorldTransform().setOrigin({9, 0, 0});
  scene.step(kFlowStep, 2);  // in another region
  EXPECT_LT(speedLeft(body), kFlowRounding);
  EXPECT_EQ(scene.of(body).medium().velocity, Vector3(0, 0, 2));
  scene.world.removeRigidBody(&body);
  scene.step(kFlowStep, 2);
  right.below.velocity = {0, 0, -2};
  scene.fluid.setRegion(static_cast<RegionId>(1), right);
  scene.world.addRigidBody(&body);
  scene.step(kFlowStep, 2);  // it was not in the world when the region changed
  EXPECT_LT(speedLeft(body), kFlowRounding);
}

TEST(ChangingFlow, DoesNotPushASleeper) {
  FluidWorld scene;
  const RegionId id = scene.fluid.addRegion(filledWith(flowingWater({0, 0, 0})));
  btRigidBody& body = addNeutralBall(scene, Medium{});
  body.forceActivationState(ACTIVE_TAG);
  scene.step(kFlowStep, 300);
  ASSERT_FALSE(body.isActive());
  scene.fluid.setRegion(id, filledWith(flowingWater({1, 0, 0})));
  scene.step(kFlowStep, 3);
  EXPECT_TRUE(body.isActive());
  EXPECT_LT(speedLeft(body), kFlowRounding);
  EXPECT_EQ(scene.of(body).medium().velocity.x(), 1);
}

// A velocity that differs from place to place, but not with time, is no acceleration.
TEST(ChangingFlow, DoesNotTakeAShearForOne) {
  FluidWorld scene;
  FluidRegion river = filledWith(idealFluid(1000));
  river.flow = [](const Vector3& x, double) { return FlowSample{{0, x.x(), 0}, {0, 0, 0}}; };
  scene.fluid.addRegion(river);
  btRigidBody& body = addNeutralBall(scene, Medium{});
  body.setLinearVelocity({2, 0, 0});
  scene.step(kFlowStep, 30);
  body.getWorldTransform().setOrigin({-7, 0, 0});
  scene.step(kFlowStep, 30);
  EXPECT_NEAR(static_cast<double>(body.getLinearVelocity().y()), 0, kFlowRounding);
  EXPECT_NEAR(static_cast<double>(body.getLinearVelocity().x()), 2, byPrecision(1e-12, 1e-5));
}

// A sea with a surface: the body afloat follows at most a quarter of gravity, and stays upright.
TEST(ChangingFlow, CarriesFloatsHoweverSudden) {
  FluidRegion sea = waterBelow(0);
  sea.below = flowingWater({0, 0, 0});
  SeaWorld scene(sea);
  const Vector3 size(1, 1, 0.3);
  const double mass = 500 * size.prod();
  const btRigidBody& body =
      scene.add({mass, boxMoments(size, mass), {}, nullptr}, floatingBox(size), Medium{});
  scene.step(kFlowStep, 60);
  sea.below.velocity = {1, 0, 0};
  scene.fluid.setRegion(RegionId{0}, sea);
  double most_tilt = 0, most_speed = 0;
  for (int i = 0; i < 120; ++i) {
    scene.step(kFlowStep);
    const double up = static_cast<double>(body.getWorldTransform().getBasis()[2][2]);
    most_tilt = std::max(most_tilt, std::acos(std::min(1.0, up)));
    most_speed = std::max(most_speed, static_cast<double>(body.getLinearVelocity().x()));
  }
  EXPECT_LT(most_tilt, 0.5);
  EXPECT_NEAR(static_cast<double>(body.getLinearVelocity().x()), 1, 0.1);
  EXPECT_LT(most_speed, 1.2);
}

TEST(ChangingFlow, GoesOnBitForBitFromASavedState) {
  FluidWorld run, other;
  const auto start = [](FluidWorld& scene) {
    const RegionId id = scene.fluid.addRegion(filledWith(flowingWater({0, 0, 1})));
    addNeutralBall(scene, Medium{});
    return SavedRun{scene.fluid, [&scene, id] {
                      const double t = scene.fluid.time();
                      const Vector3 velocity(std::sin(18 * t), 0, std::cos(12 * t));
                      scene.fluid.setRegion(id, filledWith(flowingWater(velocity)));
                      scene.step(kFlowStep);
                    }};
  };
  const SavedRun first = start(run), second = start(other);
  for (int i = 0; i < 20; ++i) first.step();
  expectGoesOn(first, second, 20);
}

}  // namespace
}  // namespace ambient::test
