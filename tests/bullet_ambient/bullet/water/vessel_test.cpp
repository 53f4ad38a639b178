#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "tests/bullet_ambient/bullet/water/vessel_world.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/refusal_of.h"

namespace ambient::test {
namespace {

TEST(Vessel, BargeWithAHoleSinksInItsTime) {
  Sea sea;
  OpenBarge barge;
  barge.hole = 0.01;
  btRigidBody& body = sea.add(barge, {});
  EXPECT_EQ(sea.water(body), 0);
  const double exact = exactTimeToDip();
  EXPECT_NEAR(exact, 116.447, 1e-3);
  EXPECT_NEAR(timeToDip(sea, body, 60), exact, 0.003 * exact);
  EXPECT_NEAR(sea.water(body), 0.8, 0.01);
  EXPECT_LT(heelOf(body), 0.01);
  sea.scene.step(1 / 60.0, 300);
  EXPECT_DOUBLE_EQ(sea.water(body), kCapacity);
  EXPECT_LT(middleOf(body), -1);
  const HoldWater hold = sea.scene.fluid.find(body)->holds().at(0);
  EXPECT_NEAR(hold.flooded - hold.drained, kCapacity, 1e-9);
  // Far below it is a body of walls in one fluid.
  sea.scene.step(1 / 60.0, 300);
  EXPECT_EQ(sea.of(body).surface(), nullptr);
}

// Rows move it.
TEST(Vessel, BargeOnARailSinksInTheSameTime) {
  Sea sea;
  OpenBarge barge;
  barge.hole = 0.01;
  btRigidBody& body = sea.add(barge, {});
  Rail rail(sea, body, 5, 0);
  const double exact = exactTimeToDip();
  EXPECT_NEAR(timeToDip(sea, body, 60), exact, 0.003 * exact);
}

TEST(Vessel, TopHeavyBargeWithWaterLolls) {
  Sea sea;
  Start start;
  start.above_keel = 0.2385;
  start.position = {0, 0, 0.05};
  start.orientation = rotationFromVector(Vector3(0.11, 0, 0));
  btRigidBody& body = sea.add({}, start, {true, {0.2}});
  sea.scene.step(1 / 60.0, 60 * 300);
  double mean = 0;
  constexpr int kSteps = 60 * 500;  // some five periods
  for (int i = 0; i < kSteps; ++i) {
    sea.scene.step(1 / 60.0);
    mean += heelOf(body) * 180 / kPi / kSteps;
  }
  EXPECT_NEAR(mean, 7.05, 0.1);
}

TEST(Vessel, EnergyNeverGrowsInCalmWater) {
  Arbitrary arbitrary(11);
  for (int i = 0; i < 16; ++i) {
    const double hertz = std::array{30.0, 60.0, 120.0, 240.0}[static_cast<std::size_t>(i) % 4];
    Sea sea;
    Start start;
    start.position.z() = arbitrary.between(-0.3, 0.3);
    start.orientation = rotationFromVector(0.5 * arbitrary.vector().normalized());
    start.twist = {arbitrary.vector().normalized(), arbitrary.vector().normalized()};
    OpenBarge barge;
    barge.holds = 1 + i % 2;
    barge.door = 0.01;
    barge.hole = i % 3 == 0 ? 0.01 : 0;
    const double room = kCapacity / barge.holds * 0.95;
    std::vector<double> water;
    for (int hold = 0; hold < barge.holds; ++hold)
      water.push_back(room * arbitrary.between(0.02, 0.98));
    btRigidBody& body = sea.add(barge, start, {i >= 4, water});
    sea.scene.step(1 / hertz);
    double energy = sea.energy(body);
    for (int k = 0; k < 400; ++k) {
      sea.scene.step(1 / hertz);
      const double next = sea.energy(body);
      EXPECT_LT(next - energy, byPrecision(1e-9, 3e-6) * kBarge * kGravity) << i << ' ' << k;
      energy = next;
    }
  }
}

// A closed barge takes in its own mass of water in one step: it keeps its momentum.
TEST(Vessel, WaterThatComesInWasAtRest) {
  Sea sea;
  Start start;
  start.twist.linear = {0.1, 0, 0};
  btRigidBody& body = sea.add({}, start, {false, {}});
  const Immersed barge = sea.scene.of(body);
  sea.scene.step(1 / 60.0);
  const auto momentum = [&] { return Sea::Water(sea, body).momentum_W().x(); };
  const double before = momentum();
  barge.pump(0, 0.2 * 60);
  sea.scene.step(1 / 60.0);
  const auto step = static_cast<double>(btScalar(1 / 60.0));  // as Bullet has it
  EXPECT_NEAR(sea.water(body), 0.2 * 60 * step, 1e-12);
  EXPECT_NEAR(momentum(), before, 0.01 * before);
}

TEST(Vessel, StateGoesOnBitForBit) {
  const auto start = [](Sea& sea) -> btRigidBody& {
    OpenBarge barge;
    barge.hole = 0.002;
    Start at;
    at.orientation = rotationFromVector(Vector3(0.1, 0.05, 0));
    return sea.add(barge, at, {true, {0.05}});
  };
  Sea sea;
  btRigidBody& body = start(sea);
  sea.scene.of(body).pump(0, -1e-4);
  sea.scene.step(1 / 60.0, 100);
  const WorldState state = sea.scene.fluid.save();
  const double before = sea.water(body);
  const auto run = [](Sea& world, btRigidBody& of) {
    world.scene.step(1 / 60.0, 200);
    return std::pair(of.getWorldTransform(), world.water(of));
  };
  const auto first = run(sea, body);
  EXPECT_GT(first.second, before + 0.001);
  sea.scene.fluid.restore(state);
  EXPECT_EQ(sea.water(body), before);
  EXPECT_TRUE(run(sea, body) == first);
  const std::shared_ptr<const FluidBody> shape = sea.scene.of(body).fluidBody();
  const WorldState read =
      decodeState(encodeState(state), "state", [&](const std::string&) { return shape; });
  Sea other;
  btRigidBody& same = start(other);
  other.scene.fluid.restore(read);
  EXPECT_TRUE(run(other, same) == first);
}

// A vessel afloat with water becomes another vessel, a body without holds, and a vessel again.
TEST(Vessel, FluidBodyIsReplacedAfloat) {
  Sea sea;
  btRigidBody& body = sea.add({}, {}, {true, {0.1}});
  const Immersed boat = sea.scene.of(body);
  sea.scene.step(1 / 60.0, 30);
  OpenBarge two;
  two.holds = 2;
  boat.setFluidBody(std::make_shared<FluidBody>(openBarge(two)));
  EXPECT_EQ(boat.holds().size(), 2u);
  EXPECT_EQ(boat.holds().at(0).volume, 0);
  EXPECT_GT(boat.kineticEnergy(), 0);
  sea.scene.step(1 / 60.0, 30);
  FluidBody closed = openBarge({});
  closed.holds.clear();
  boat.setFluidBody(std::make_shared<FluidBody>(closed));
  EXPECT_TRUE(boat.holds().empty());
  EXPECT_GT(boat.wet().volume, 0);
  sea.scene.step(1 / 60.0, 30);
  boat.setFluidBody(std::make_shared<FluidBody>(openBarge({})));
  boat.setWater(0, 0.05);
  boat.addOpening(0, {0, 0, -0.23}, {0, 0, -1}, 1e-3);
  sea.scene.step(1 / 60.0, 30);
  EXPECT_GT(sea.water(body), 0.05);
  boat.setFluidBody(std::make_shared<FluidBody>(openBarge(two)));
  EXPECT_TRUE(sea.of(body).vessel->changes.holes.empty());
  sea.scene.step(1 / 60.0, 600);
  EXPECT_NEAR(middleOf(body), 0.25 - 0.1, 2e-3);
}

TEST(Vessel, DryBargeSleepsAndALeakingOneDoesNot) {
  for (const double hole : {0.0, 1e-4}) {
    Sea sea;
    OpenBarge barge;
    barge.hole = hole;
    btRigidBody& body = sea.add(barge, {});
    body.forceActivationState(ACTIVE_TAG);
    sea.scene.step(1 / 60.0, 60 * 60);
    EXPECT_EQ(body.isActive(), hole > 0);
    if (hole > 0) continue;
    sea.scene.of(body).setWater(0, 0.1);
    EXPECT_TRUE(body.isActive());
  }
}

TEST(Vessel, WreckStartsFloodedAndASealedOneRises) {
  for (const bool are_open : {true, false}) {
    Sea sea;
    Start start;
    start.position.z() = -30;
    btRigidBody& body = sea.add({}, start, {are_open, {}});
    EXPECT_EQ(sea.scene.of(body).holds().at(0).volume, are_open ? kCapacity : 0);
    sea.scene.step(1 / 60.0, 120);
    EXPECT_EQ(middleOf(body) < -30, are_open);
    EXPECT_EQ(sea.water(body), are_open ? kCapacity : 0);
  }
}

TEST(Vessel, WaterIsSetPumpedAndRead) {
  Sea sea;
  btRigidBody& body = sea.add({}, {});
  const Immersed barge = sea.scene.of(body);
  sea.scene.step(1 / 60.0, 600);
  barge.setWater(0, 0.2);
  const HoldWater set = barge.holds().at(0);
  EXPECT_EQ(set.volume, 0.2);
  EXPECT_DOUBLE_EQ(set.capacity, kCapacity);
  EXPECT_NEAR(set.area, 1.96 * 0.96, byPrecision(1e-9, 1e-4));
  EXPECT_NEAR(set.freeboard, 0.48 - 0.2 / (1.96 * 0.96), byPrecision(1e-6, 1e-3));
  EXPECT_NEAR(set.centre.z(), middleOf(body) - 0.23 + 0.1 / (1.96 * 0.96), 1e-3);
  EXPECT_NEAR(set.level.z(), middleOf(body) + 0.25 - set.freeboard, 1e-3);
  sea.scene.step(1 / 60.0, 1800);
  EXPECT_NEAR(middleOf(body), 0.25 - 0.2, 2e-3) << "draught 0.2 m";
  barge.pump(0, -0.01);
  sea.scene.step(1 / 60.0, 600);
  EXPECT_NEAR(sea.water(body), 0.1, byPrecision(1e-12, 1e-8)) << "of the step";
  EXPECT_NEAR(barge.holds()[0].inflow, -0.01 / 60, byPrecision(1e-15, 1e-9));
  sea.scene.step(1 / 60.0, 1800);
  EXPECT_EQ(sea.water(body), 0);
  EXPECT_NEAR(middleOf(body), 0.25 - 0.1, 2e-3);
}

TEST(Vessel, WhatDoesNotFitIsRefusedInOneLine) {
  Sea sea;
  const auto refusal = [](const auto& action) { return refusalOf<std::invalid_argument>(action); };
  EXPECT_EQ(refusal([&] {
              sea.add({}, {}, {true, {1}});
            }),
            "add: body with fluid body 'barge' has 1.000000 m^3 of water in hold 0, which must be "
            "zero to 0.903168");
  EXPECT_EQ(refusal([&] {
              sea.add({}, {}, {true, {0.1, 0.1}});
            }),
            "add: body with fluid body 'barge' has water for 2 holds, but its fluid body has 1");
  const Immersed barge = sea.scene.of(sea.add({}, {}));
  EXPECT_EQ(refusal([&] { barge.setWater(1, 0); }),
            "setWater: body with fluid body 'barge' has 1 holds, and none has the number 1");
  EXPECT_EQ(refusal([&] { barge.setWater(0, -1); }),
            "setWater: body with fluid body 'barge' has -1.000000 m^3 of water in hold 0, which "
            "must be zero to 0.903168");
  EXPECT_EQ(refusal([&] { barge.setOpening(0, 1, false); }),
            "setOpening: hold 0 of body with fluid body 'barge' has no opening with the number 1");
  EXPECT_EQ(refusal([&] {
              barge.addOpening(0, {0, 0, 0}, {0, 0, -1}, 0);
            }),
            "addOpening: body with fluid body 'barge' would have a hole of 0.000000 m^2, which "
            "must be positive and finite");
  EXPECT_EQ(refusal([&] {
              barge.addOpening(0, {0, 0, 0}, {0, 0, 0}, 1);
            }),
            "addOpening: body with fluid body 'barge' would have a hole without a direction out "
            "of the hold");
  EXPECT_EQ(refusal([&] {
              barge.addOpening(0, {0, 3, 0}, {0, 0, 1}, 1);
            }),
            "addOpening: body with fluid body 'barge' would have a hole at (0.000000, 3.000000, "
            "0.000000) m in the frame of its fluid body, which is not at the body");
  EXPECT_EQ(refusal([&] { barge.pump(0, INFINITY); }),
            "pump: the rate [m^3/s] is inf, must be finite");
}

}  // namespace
}  // namespace ambient::test
