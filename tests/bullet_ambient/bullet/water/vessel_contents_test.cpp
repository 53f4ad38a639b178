#include <gtest/gtest.h>

#include <tuple>

#include "tests/bullet_ambient/bullet/water/vessel_world.h"

// Bodies in the hold of a barge, without contacts.
namespace ambient::test {
namespace {

constexpr double kWater = 0.2;

btRigidBody& addBox(Sea& sea, const Vector3& size, double mass, const Vector3& position) {
  BodyDef def{
      mass, mass / 12 * (Vector3::Constant(size.squaredNorm()) - size.cwiseAbs2()), {}, nullptr};
  def.start.position = position;
  return sea.scene.add(def, floatingBox(size, 1), Medium{});
}

/// The barge where it floats with a load [kg].
btRigidBody& addAfloat(Sea& sea, double water, double load) {
  Start start;
  start.position.z() = 0.25 - ((kBarge + load) / 1000 + water) / 2;
  return sea.add({}, start, {true, {water}});
}

double speedOf(const btRigidBody& body) {
  return static_cast<double>(body.getLinearVelocity().z());
}

// Below the sea's level, in the barge's dry hold, a light box falls; beside the barge it rises.
TEST(VesselContents, ADryHoldIsDry) {
  Sea sea;
  addAfloat(sea, 0, 0);
  const Vector3 size(0.1, 0.1, 0.1);
  btRigidBody& in = addBox(sea, size, 0.2, {0.3, 0, -0.02});
  btRigidBody& beside = addBox(sea, size, 0.2, {5, 0, -0.02});
  sea.scene.step(1 / 240.0);
  in.setLinearVelocity({0, 0, 0});
  sea.scene.step(1 / 240.0, 3);
  EXPECT_NEAR(speedOf(in), -3 / 240.0 * kGravity, byPrecision(1e-12, 1e-6));
  EXPECT_GT(speedOf(beside), 0);
  EXPECT_EQ(sea.scene.of(in).wet().volume, 0);
  EXPECT_NEAR(sea.scene.of(beside).wet().volume, 0.1 * 0.1 * 0.07, 1e-4);
}

// A toy boat that displaces 4.5 l in the barge's water.
TEST(VesselContents, WhatFloatsInAHoldLoadsTheVesselAndLiftsTheLevel) {
  Sea sea;
  constexpr double kToy = 4.5;
  btRigidBody& barge = addAfloat(sea, kWater, kToy);
  const double floor = -((kBarge + kToy) / 1000 + kWater) / 2 + 0.02;
  const double level = floor + (kWater + kToy / 1000) / (1.96 * 0.96);
  btRigidBody& toy = addBox(sea, {0.3, 0.3, 0.1}, kToy, {0, 0, level + 0.02});
  sea.scene.step(1 / 60.0, 60 * 60);
  EXPECT_NEAR(middleOf(barge), floor + 0.23, 1e-3);
  const Immersed in_hold = sea.scene.of(toy);
  EXPECT_NEAR(in_hold.wet().volume, kToy / 1000, 0.02 * kToy / 1000);
  EXPECT_NEAR(sea.of(barge).vessel->holds[0].displaced, kToy / 1000, 0.02 * kToy / 1000);
  EXPECT_NEAR(static_cast<double>(toy.getWorldTransform().getOrigin().z()), level, 1e-3);
  EXPECT_EQ(sea.water(barge), kWater);
}

// In a tub on land, far above the sea.
TEST(VesselContents, AToyFloatsInATubOnLand) {
  Sea sea;
  Start start;
  start.position.z() = 5;
  btRigidBody& tub = sea.add({}, start, {true, {kWater}});
  Rail rail(sea, tub, 0, 0);
  const double level = 5 - 0.23 + (kWater + 0.0045) / (1.96 * 0.96);
  btRigidBody& toy = addBox(sea, {0.3, 0.3, 0.1}, 4.5, {0.2, 0.1, level});
  sea.scene.step(1 / 60.0, 600);
  EXPECT_NEAR(static_cast<double>(toy.getWorldTransform().getOrigin().z()), level, 2e-3);
  EXPECT_NEAR(sea.scene.of(toy).wet().volume, 0.0045, 1e-4);
  EXPECT_NEAR(middleOf(tub), 5, 1e-3);
}

TEST(VesselContents, StateGoesOnBitForBit) {
  const auto start = [](Sea& sea) {
    btRigidBody& barge = addAfloat(sea, kWater, 4.5);
    return std::pair(&barge, &addBox(sea, {0.3, 0.3, 0.1}, 4.5, {0.1, 0.05, -0.05}));
  };
  Sea sea;
  const auto [barge, toy] = start(sea);
  sea.scene.step(1 / 60.0, 30);
  const WorldState state = sea.scene.fluid.save();
  const auto run = [](Sea& world, const btRigidBody& one, const btRigidBody& two) {
    world.scene.step(1 / 60.0, 60);
    return std::tuple(one.getWorldTransform(), two.getWorldTransform());
  };
  const auto first = run(sea, *barge, *toy);
  sea.scene.fluid.restore(state);
  EXPECT_TRUE(run(sea, *barge, *toy) == first);
}

// A body that has left its hold, or whose vessel has gone, is in the sea again.
TEST(VesselContents, WithoutItsVesselABodyIsInTheSea) {
  Sea sea;
  btRigidBody& barge = addAfloat(sea, 0, 0);
  btRigidBody& box = addBox(sea, {0.1, 0.1, 0.1}, 0.2, {0.3, 0, -0.02});
  sea.scene.step(1 / 240.0);
  EXPECT_EQ(sea.scene.of(box).wet().volume, 0);
  sea.scene.of(barge).remove();
  sea.scene.step(1 / 240.0, 2);
  EXPECT_GT(sea.scene.of(box).wet().volume, 0);
}

}  // namespace
}  // namespace ambient::test
