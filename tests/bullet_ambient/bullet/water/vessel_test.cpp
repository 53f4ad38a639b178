#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include "tests/bullet_ambient/bullet/state/state_scene.h"
#include "tests/bullet_ambient/bullet/water/vessel_world.h"
#include "tests/support/bodies/random_bodies.h"

namespace ambient::test {
namespace {

/// Rates of steps [1/s].
constexpr double kHertz[] = {30, 60, 120, 240};

TEST(Vessel, BargeWithAHoleSinksInItsTime) {
  Sea sea, other;
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
  EXPECT_FALSE(hold.has_trapped_air);
  // Far below it is a body of walls in one fluid.
  sea.scene.step(1 / 60.0, 300);
  EXPECT_EQ(sea.of(body).surface(), nullptr);
  btRigidBody& moved_by_rows = other.add(barge, {});
  Rail rail(other, moved_by_rows, 5, 0);
  EXPECT_NEAR(timeToDip(other, moved_by_rows, 60), exact, 0.003 * exact);
}

TEST(Vessel, EnergyNeverGrowsInCalmWater) {
  Arbitrary arbitrary(11);
  for (int i = 0; i < 16; ++i) {
    SCOPED_TRACE(i);
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
    expectEnergyNeverGrows(sea, sea.add(barge, start, {i >= 4, water}), kBarge, kHertz[i % 4]);
  }
}

// Energies of air are up to 91 kJ: their rounding counts where poses are floats.
TEST(Vessel, EnergyNeverGrowsWhereWaterShutsOffAir) {
  Arbitrary arbitrary(12);
  int sealed = 0;
  for (int i = 0; i < 16; ++i) {
    SCOPED_TRACE(i);
    Sea sea;
    Start start = capsized();
    start.position.z() = arbitrary.between(-1, 0.3);
    start.orientation = rotationFromVector(arbitrary.vector().normalized()) * start.orientation;
    start.twist = {arbitrary.vector().normalized(), arbitrary.vector().normalized()};
    start.mass = arbitrary.between(150, 1500);
    OpenBarge barge;
    barge.holds = 1 + i % 2;
    barge.door = i % 4 < 2 ? 0.01 : 0;
    btRigidBody& body = sea.add(barge, start, {true, std::vector<double>(barge.holds, 0.05)});
    sealed += expectEnergyNeverGrows(sea, body, start.mass, kHertz[i % 4]);
  }
  EXPECT_GT(sealed, 2000);
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

/// Column of air in a room of a depth L whose mouth is under by d: p_0 L = (p_0 + rho g (d - L +
/// x)) x.
double airColumn(double mouth, double room) {
  const double head = kAtmosphere / (1000 * kGravity), b = head + mouth - room;
  return (std::sqrt(b * b + 4 * head * room) - b) / 2;
}

// A bell sinks on its rail to its stop.
TEST(Vessel, DivingBellKeepsItsAirUnderPressure) {
  for (const double hertz : {30.0, 60.0, 240.0}) {
    Sea sea;
    Start start = capsized();
    start.position.z() = 1;
    start.mass = 2000;
    btRigidBody& body = sea.add({}, start);
    Rail rail(sea, body, 4, 0);
    sea.scene.step(1 / hertz, static_cast<int>(20 * hertz));
    const double mouth = 0.25 - middleOf(body, 0.37);
    EXPECT_NEAR(mouth, 3.25, 0.01);
    const HoldWater hold = sea.scene.of(body).holds().at(0);
    EXPECT_TRUE(hold.has_trapped_air);
    const double column = airColumn(mouth, 0.48);
    EXPECT_NEAR(hold.capacity - hold.volume, 1.96 * 0.96 * column, byPrecision(1e-6, 1e-4))
        << hertz;
    EXPECT_NEAR(hold.air_pressure, kAtmosphere * 0.48 / column, byPrecision(1, 30));
    EXPECT_NEAR(hold.flooded - hold.drained, hold.volume, 1e-9);
  }
}

// With a rim at a depth T and water up to w in it: m / rho = L B T - A w, and its air by Boyle.
TEST(Vessel, BoatThatTurnsOverFloatsOnItsAir) {
  double low = 0, high = 0.5, rim = 0, water = 0;
  for (int i = 0; i < 100; ++i) {
    rim = (low + high) / 2;
    water = 0.48 - airColumn(rim, 0.48);
    (2 * rim - 1.96 * 0.96 * water < 0.2 ? low : high) = rim;
  }
  for (const double hertz : {30.0, 60.0, 240.0}) {
    Sea sea;
    Start start = capsized();
    start.above_keel = 0.42;
    start.position.z() = 0.15;
    btRigidBody& body = sea.add({}, start);
    sea.scene.step(1 / hertz, static_cast<int>(120 * hertz));
    EXPECT_GT(heelOf(body), kPi - 0.01) << hertz;
    EXPECT_NEAR(0.25 - middleOf(body, 0.08), rim, 1e-3) << hertz;
    EXPECT_NEAR(sea.water(body), 1.96 * 0.96 * water, 1e-3) << hertz;
  }
}

// Bodies in the hold of a barge, without contacts.

btRigidBody& addBox(Sea& sea, const Vector3& size, double mass, const Vector3& position) {
  return sea.scene.add({mass, boxMoments(size, mass), startAt(position)}, floatingBox(size, 1),
                       Medium{});
}

/// The barge where it floats with a load [kg].
btRigidBody& addBarge(Sea& sea, double water, double load) {
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
  addBarge(sea, 0, 0);
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
  btRigidBody& barge = addBarge(sea, kWater, kToy);
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

// The only body that fits in a hold is taken out of the fluid.
TEST(VesselContents, TheLevelFallsWhenTheLastBodyHasGone) {
  Sea sea;
  btRigidBody& barge = addBarge(sea, kWater, 4.5);
  btRigidBody& toy = addBox(sea, {0.3, 0.3, 0.1}, 4.5, {0, 0, -0.05});
  sea.scene.step(1 / 60.0, 10);
  EXPECT_GT(sea.of(barge).vessel->holds[0].displaced, 0);
  sea.scene.of(toy).remove();
  sea.scene.step(1 / 60.0);
  EXPECT_EQ(sea.of(barge).vessel->holds[0].displaced, 0);
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

// A body that has left its hold, or whose vessel has gone, is in the sea again.
TEST(VesselContents, WithoutItsVesselABodyIsInTheSea) {
  Sea sea;
  btRigidBody& barge = addBarge(sea, 0, 0);
  btRigidBody& box = addBox(sea, {0.1, 0.1, 0.1}, 0.2, {0.3, 0, -0.02});
  sea.scene.step(1 / 240.0);
  EXPECT_EQ(sea.scene.of(box).wet().volume, 0);
  sea.scene.of(barge).remove();
  sea.scene.step(1 / 240.0, 2);
  EXPECT_GT(sea.scene.of(box).wet().volume, 0);
}

// Water that sloshes in the hold of a barge.

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
    const double exact = kWavePerPlane * kSpeed * exactRate() / kGravity;
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

// Each two minutes of ten are calmer than those before, whatever the precision.
TEST(VesselSloshing, DiesOutWithinTenMinutes) {
  Sea sea;
  btRigidBody& body = addAfloat(sea, {{0.3, 0.2, 0.1}, {0.3, 0.2, 0.1}});
  std::vector<double> largest;
  for (int i = 0; i < 5; ++i) {
    largest.push_back(0);
    for (int k = 0; k < 120 * 60; ++k) {
      sea.scene.step(1 / 60.0);
      const double speed = static_cast<double>(body.getAngularVelocity().length() +
                                               body.getLinearVelocity().length());
      largest.back() = std::max(largest.back(), speed);
    }
    if (i > 0) {
      EXPECT_LT(largest[i], largest[i - 1]) << i;
    }
  }
  EXPECT_LT(largest.back(), 0.1 * largest.front());
}

// Saved states hold more than poses and velocities: water and pumps, air that is shut off, holes
// that were shot and doors that were shut, bodies in a hold, water that sloshes.
TEST(Vessel, StatesGoOnBitForBit) {
  struct Case {
    const char* what;
    std::function<btRigidBody&(Sea&)> build;  ///< both worlds
    std::function<void(const Immersed&)> change;
    int before, after;
    std::function<bool(const AmbientBody&)> has;
  };
  OpenBarge leaky, holed;
  leaky.hole = 0.002;
  holed.hole = 0.01;
  Start heeled, down = capsized();
  heeled.orientation = rotationFromVector(Vector3(0.1, 0.05, 0));
  down.mass = 1000;
  down.position.z() = 0.2;
  const auto nothing = [](const Immersed&) {};
  const Case cases[] = {
      {"a leak and a pump",
       [&](Sea& sea) -> btRigidBody& {
         return sea.add(leaky, heeled, {true, {0.05}});
       },
       [](const Immersed& barge) { barge.pump(0, -1e-4); }, 100, 200,
       [](const AmbientBody& body) { return body.vessel->holds[0].volume > 0.05; }},
      {"air", [&](Sea& sea) -> btRigidBody& { return sea.add({}, down, {}); }, nothing, 60, 200,
       [](const AmbientBody& body) { return body.vessel->holds[0].is_sealed; }},
      {"holes", [&](Sea& sea) -> btRigidBody& { return sea.add(holed, {}, {}); },
       [](const Immersed& barge) {
         barge.setOpening(0, 1, false);
         barge.addOpening(0, {0.5, 0.2, -0.23}, {0, 0, -1}, 0.002);
       },
       100, 200, [](const AmbientBody& body) { return body.vessel->changes.holes.size() == 1; }},
      {"a toy",
       [&](Sea& sea) -> btRigidBody& {
         btRigidBody& barge = addBarge(sea, kWater, 4.5);
         addBox(sea, {0.3, 0.3, 0.1}, 4.5, {0.1, 0.05, -0.05});
         return barge;
       },
       nothing, 30, 60,
       [](const AmbientBody& body) { return body.vessel->holds[0].displaced > 0; }},
      {"waves inside",
       [&](Sea& sea) -> btRigidBody& {
         return addAfloat(sea, {{0.3, 0.2, 0}, {0.3, 0.1, 0}});
       },
       nothing, 50, 100,
       [](const AmbientBody& body) { return !body.vessel->sloshing.now.empty(); }}};
  for (const Case& c : cases) {
    SCOPED_TRACE(c.what);
    Sea sea, other;
    btRigidBody &body = c.build(sea), &same = c.build(other);
    c.change(sea.scene.of(body));
    sea.scene.step(1 / 60.0, c.before);
    EXPECT_TRUE(c.has(sea.of(body)));
    const WorldState state = sea.scene.fluid.save();
    const auto run = [](Sea& of) {
      return SavedRun{of.scene.fluid, [&of] { of.scene.step(1 / 60.0); }};
    };
    expectGoesOn(run(sea), run(other), c.after);
    sea.scene.fluid.restore(state);
    expectGoesOn(run(sea), run(sea), c.after);
    EXPECT_EQ(other.water(same), sea.water(body));
  }
}

}  // namespace
}  // namespace ambient::test
