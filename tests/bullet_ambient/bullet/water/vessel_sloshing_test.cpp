#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

#include "tests/bullet_ambient/bullet/water/vessel_world.h"

// Water that sloshes in the hold of a barge.
namespace ambient::test {
namespace {

constexpr double kLength = 1.96, kDepth = kWater / (1.96 * 0.96);

/// First frequency along the hold [1/s].
double exactRate() {
  const double k = kPi / kLength;
  return std::sqrt(kGravity * k * std::tanh(k * kDepth));
}

/// A barge with water, upright where it floats.
btRigidBody& addAfloat(Sea& sea, const Twist& twist = {}, double damping = 0.03) {
  Start start;
  start.position.z() = 0.25 - (kBarge / 1000 + kWater) / 2;
  start.twist = twist;
  return sea.add({}, start, {true, {kWater}, kAtmosphere, damping});
}

/// Slope of the surface along x.
double slopeOf(const Sea& sea, const btRigidBody& body) {
  const Vector3 normal = sea.scene.fluid.find(body)->holds().at(0).normal;
  return -normal.x() / normal.z();
}

// A joint stops a barge at once. Its water goes on, and swings at its own frequency.
TEST(VesselSloshing, WaterOfABargeThatStopsGoesOn) {
  constexpr double kSpeed = 0.03;  // its waves are far from the floor
  for (const double hertz : {60.0, 240.0}) {
    Sea sea;
    btRigidBody& body = addAfloat(sea, {{0, 0, 0}, {kSpeed, 0, 0}}, 0);
    sea.scene.step(1 / hertz);
    EXPECT_NEAR(slopeOf(sea, body), 0, 5e-4) << "it moves with the barge at first";
    Rail rail(sea, body, 0, 0);
    double highest = 0, last = 0, first_time = 0, last_time = 0;
    int crossings = 0;
    const int steps = static_cast<int>(12 * hertz);
    for (int i = 0; i < steps; ++i) {
      sea.scene.step(1 / hertz);
      const double slope = slopeOf(sea, body), time = i / hertz;
      highest = std::max(highest, slope);
      if (last * slope < 0) {
        const double at = time - slope / (slope - last) / hertz;
        (crossings++ == 0 ? first_time : last_time) = at;
      }
      last = slope;
    }
    ASSERT_GE(crossings, 4);
    EXPECT_NEAR(kPi * (crossings - 1) / (last_time - first_time), exactRate(), 0.01 * exactRate())
        << hertz;
    // The joint's rows damp it, in proportion to the step.
    const double exact = kSpeed * exactRate() / kGravity;
    EXPECT_NEAR(highest, exact, 6 / hertz * exact);
  }
}

// The sea gives a barge that glides to and fro no push along x: the water in it does.
TEST(VesselSloshing, PushOfTheWaterMovesTheBarge) {
  Sea sea;
  btRigidBody& body = addAfloat(sea);
  sea.scene.step(1 / 60.0);
  const double before = Sea::Water(sea, body).momentum_W().x();
  EXPECT_NEAR(before, 0, 1e-3);
  sea.scene.of(body).applyImpulse({{0, 0, 0}, {100, 0, 0}});
  double most = 0, least = 1;
  for (int i = 0; i < 240; ++i) {
    sea.scene.step(1 / 60.0);
    const double speed = static_cast<double>(body.getLinearVelocity().x());
    most = std::max(most, speed);
    if (i > 30) least = std::min(least, speed);
  }
  // The part of the water that swings takes its share of the momentum, and gives it back.
  EXPECT_LT(least, 0.7 * most);
}

TEST(VesselSloshing, StateGoesOnBitForBit) {
  Sea sea;
  btRigidBody& body = addAfloat(sea, {{0.3, 0.2, 0}, {0.3, 0.1, 0}});
  sea.scene.step(1 / 60.0, 50);
  ASSERT_GT(Sea::Water(sea, body).energy().potential, 0.01);
  const WorldState state = sea.scene.fluid.save();
  const auto run = [](Sea& world, btRigidBody& of) {
    world.scene.step(1 / 60.0, 100);
    return std::tuple(of.getWorldTransform(), slopeOf(world, of));
  };
  const auto first = run(sea, body);
  Sea other;
  btRigidBody& same = addAfloat(other, {{0.3, 0.2, 0}, {0.3, 0.1, 0}});
  restore(other, state, sea.scene.of(body).fluidBody());
  EXPECT_TRUE(run(other, same) == first);
}

// Water that sways keeps it awake, still water does not.
TEST(VesselSloshing, BargeSleepsWithStillWater) {
  for (const double spin : {0.0, 0.01}) {
    Sea sea;
    btRigidBody& body = addAfloat(sea, {{0, spin, 0}, {0, 0, 0}});
    body.forceActivationState(ACTIVE_TAG);
    sea.scene.step(1 / 60.0);
    EXPECT_EQ(sea.of(body).may_rest, spin == 0);
    sea.scene.step(1 / 60.0, 60 * 20);
    EXPECT_EQ(body.isActive(), spin > 0);
  }
}

}  // namespace
}  // namespace ambient::test
