#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "bullet_ambient/force/medium/waves.h"
#include "bullet_ambient/saved_state.h"
#include "tests/bullet_ambient/bullet/water/vessel_world.h"
#include "tests/support/refusal_of.h"
#include "tests/support/runs.h"

namespace ambient::test {
namespace {

// Waves wash over the rim of a barge that is held and rolls, in and out.
TEST(Vessel, WavesNeitherMakeNorLoseWater) {
  const std::vector<WaveComponent> waves{{0.3, 4, {1, 0.3, 0}, 0}, {0.2, 2.9, {0.2, 1, 0}, 1}};
  Sea sea(std::make_shared<AiryWaves>(CalmSea{}, waves));
  Start start;
  start.position.z() = -0.1;
  btRigidBody& body = sea.add({}, start, {true, {0.3}});
  Rail rail(sea, body, 0, 0.3);
  double sum = 0.3, come = 0, gone = 0;
  const unsigned steps = runsOf(100000);
  for (unsigned i = 0; i < steps; ++i) {
    sea.scene.step(1 / 60.0);
    const double inflow = sea.of(body).vessel->holds[0].inflow;
    sum += inflow;
    (inflow > 0 ? come : gone) += std::abs(inflow);
  }
  EXPECT_NEAR(sea.water(body), sum, 1e-12 * kCapacity);
  EXPECT_GT(come, 3e-4 * steps);
  EXPECT_GT(gone, 3e-4 * steps);
  const HoldWater hold = sea.scene.fluid.find(body)->holds().at(0);
  EXPECT_NEAR(hold.flooded, come, 1e-9);
  EXPECT_NEAR(hold.drained, gone, 1e-9);
}

/// What comes over the rim of an empty barge in waves along x, by Poleni's formula at each place
/// [m^3].
double overRim(const WaveComponent& wave, double freeboard, double time) {
  constexpr int kSteps = 2000, kPlaces = 400;
  const double k = 4 * kPi * kPi / (wave.period * wave.period * kGravity);
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double phase = 2 * kPi / wave.period * (i + 0.5) / kSteps * time - wave.phase;
    const auto over = [&](double x) {
      return std::pow(std::max(0.0, wave.amplitude * std::cos(k * x - phase) - freeboard), 1.5);
    };
    for (int j = 0; j < kPlaces; ++j)
      sum += 2 * over(1.96 * ((j + 0.5) / kPlaces - 0.5)) * 1.96 / kPlaces;
    sum += 0.96 * (over(0.98) + over(-0.98));
  }
  return 0.6 * std::sqrt(2 * kGravity) * 2 / 3 * sum * time / kSteps;
}

/// A tray on a shaking table far above the sea, the water in it 8 cm below its rim, after ten
/// seconds: what has gone over the rim [m^3].
double shakenOut(double hertz, double amplitude) {
  constexpr double kFilled = 0.75;
  const double k = kPi / 1.96, depth = kFilled / (1.96 * 0.96);
  const double rate = std::sqrt(kGravity * k * std::tanh(k * depth));  // of the water
  Sea sea;
  Start start;
  start.position.z() = 5;
  start.mass = 1e6;
  btRigidBody& tray = sea.add({}, start, {true, {kFilled}});
  double gone = 0;
  for (int i = 0; i < 10 * hertz; ++i) {
    const double speed = amplitude * rate * std::cos(rate * (i + 0.5) / hertz);
    tray.setLinearVelocity({bt(speed), 0, bt(kGravity / hertz / 2)});
    tray.setAngularVelocity({0, 0, 0});
    sea.scene.step(1 / hertz);
    gone -= sea.of(tray).vessel->holds[0].inflow;
  }
  EXPECT_NEAR(sea.water(tray) + gone, kFilled, 1e-12 * kCapacity) << hertz;
  return gone;
}

TEST(Vessel, TrayThatIsShakenSlopsOver) {
  for (const double hertz : {30.0, 60.0, 240.0}) {
    EXPECT_GT(shakenOut(hertz, 0.07), 1e-3) << hertz;
    EXPECT_EQ(shakenOut(hertz, 0.035), 0) << hertz;
  }
}

/// Gives the water of a barge a way along x and y [m].
void sway(Sea& sea, const btRigidBody& body, double x, double y) {
  ambientBodiesOf(sea.scene.fluid).find(&body)->vessel->sloshing.now[0] = {
      true, {x, y, 0}, {0, 0, 0}};
}

// The waves inside lift water over a rim that is above both levels, also where that inside is the
// lower one.
TEST(Vessel, EnergyNeverGrowsWhereWaterSlopsOver) {
  for (const double hertz : {30.0, 60.0, 240.0})
    for (const double mass : {200.0, 500.0}) {
      SCOPED_TRACE(hertz);
      Sea sea;
      Start start;
      start.mass = mass;
      start.position.z() = 0.25 - (mass / 1000 + 0.4) / 2;
      start.twist.angular = {0.2, 0.1, 0};
      btRigidBody& body = sea.add({}, start, {true, {0.4}});
      sway(sea, body, 0.8, 0.4);
      expectEnergyNeverGrows(sea, body, mass, hertz);
      const HoldWater hold = sea.scene.fluid.find(body)->holds().at(0);
      EXPECT_GT(hold.drained, 1e-4);
      EXPECT_NEAR(hold.volume - 0.4, hold.flooded - hold.drained, 1e-12 * kCapacity);
    }
}

// A box as heavy as the water in a barge goes on through it, and takes the barge along.
TEST(Vessel, DragOfABodyInAHoldMovesTheVessel) {
  constexpr double kMass = 4;
  for (const double hertz : {60.0, 240.0}) {
    Sea sea;
    Start start;
    start.position.z() = 0.25 - (kBarge + kMass + 400) / 2000;
    btRigidBody& barge = sea.add({}, start, {true, {0.4}});
    BodyDef def{kMass, kMass * Vector3(0.005, 0.005, 0.007),
                startAt({-0.6, 0, -0.18}, {Vector3::Zero(), {0.5, 0, 0}})};
    btRigidBody& box = sea.scene.add(def, floatingBox({0.2, 0.2, 0.1}, 1), Medium{});
    const auto speed = [](const btRigidBody& body) {
      return static_cast<double>(body.getLinearVelocity().x());
    };
    // Of the box past the water, with what moves round it, and of the rest.
    const auto momentum = [&] {
      RigidState state = readState(box);
      state.twist.linear -= state.orientation.conjugate() * Vector3(speed(barge), 0, 0);
      const Vector6 past = sea.of(box).flotation().inertia.full() * state.twist.vector();
      return Sea::Water(sea, barge).momentum_W().x() + kMass * speed(barge) +
             (state.orientation * Vector3(past.tail<3>())).x();
    };
    sea.scene.step(1 / hertz, 3);
    const double before = momentum();
    sea.scene.step(1 / hertz, static_cast<int>(hertz));
    EXPECT_LT(speed(box), 0.4) << hertz;
    EXPECT_NEAR(momentum(), before, 0.02 * before) << hertz;
  }
}

// Waves half as long as a barge that is held slop over its rim, where it meets them.
TEST(Vessel, WavesShorterThanTheHullComeOverItsRim) {
  for (const double length : {1.0, 2.0}) {
    const WaveComponent wave{0.04, std::sqrt(2 * kPi * length / kGravity), {1, 0, 0}, 0.3};
    Sea sea(std::make_shared<AiryWaves>(CalmSea{}, std::vector<WaveComponent>{wave}));
    Start start;
    start.position.z() = -0.23;
    btRigidBody& body = sea.add({}, start, {true, {0}});
    Rail rail(sea, body, 0, 0);
    const double time = 6 * wave.period;
    sea.scene.step(1 / 240.0, static_cast<int>(std::lround(time * 240)));
    const double exact = overRim(wave, 0.02, time);
    EXPECT_NEAR(sea.water(body), exact, 0.02 * exact) << length;
    EXPECT_NE(sea.of(body).vessel->waves, nullptr);
  }
}

// Nothing is asked for where the sea is still, or the waves are long.
TEST(Vessel, RimIsThatOfThePlaneInLongWaves) {
  const WaveComponent swell{0.04, 12, {1, 0, 0}, 0};
  Sea sea(std::make_shared<AiryWaves>(CalmSea{}, std::vector<WaveComponent>{swell}));
  btRigidBody& body = sea.add({}, {});
  sea.scene.step(1 / 60.0);
  EXPECT_EQ(sea.of(body).vessel->waves, nullptr);
}

// A hole shot into the floor floods as one that the shape has; shut, it does not; open again, it
// does.
TEST(Vessel, HoleThatIsShotIntoAHullSinksIt) {
  Sea sea;
  btRigidBody& body = sea.add({}, {});
  const Immersed barge = sea.scene.of(body);
  sea.scene.step(1 / 60.0, 600);
  EXPECT_EQ(sea.water(body), 0);
  EXPECT_EQ(barge.addOpening(0, {0.3, 0, -0.23}, {0, 0, -2}, 0.01), 1);
  const double level = barge.holds().at(0).freeboard;
  EXPECT_NEAR(level, 0, 1e-6) << "its lowest opening is in the floor";
  sea.scene.step(1 / 60.0, 60);
  const double flooded = sea.water(body);
  EXPECT_NEAR(flooded, 0.6 * 0.01 * std::sqrt(2 * kGravity * 0.08), 4e-4) << "at 0.08 m of head";
  barge.setOpening(0, 1, false);
  sea.scene.step(1 / 60.0, 600);
  EXPECT_EQ(sea.water(body), flooded);
  EXPECT_NEAR(barge.holds().at(0).freeboard, 0.48 - flooded / (1.96 * 0.96), 2e-3);
  barge.setOpening(0, 1, true);
  const double exact = exactTimeToDip();
  EXPECT_NEAR(timeToDip(sea, body, 60), exact - 1, 0.01 * exact);
}

// It is said once, in this step and after a restored one; of another vessel once more. What stays
// afloat or begins as a wreck is not spoken of.
TEST(Vessel, SaysOnceThatItSinks) {
  Sea sea;
  OpenBarge barge;
  barge.hole = 0.05;
  btRigidBody& body = sea.add(barge, {});
  Start beside;
  beside.position.y() = 20;
  beside.mass = 500;
  sea.add(barge, beside);
  Start wreck;
  wreck.position = {20, 0, -3};
  sea.add(barge, wreck);
  Start light;
  light.position = {20, 20, 0};
  light.mass = 60;
  btRigidBody& afloat = sea.add(barge, light);
  const WorldState before = sea.scene.fluid.save();
  const std::string sentence =
      "bullet_ambient: a body with fluid body 'barge' sinks: its hold 'hold' of 0.9032 m^3 is full "
      "of water";
  sea.scene.step(1 / 60.0, 60 * 60);
  EXPECT_EQ(sea.scene.said, (std::vector<std::string>{sentence, sentence}));
  // Floor and walls displace 60 l where it is 0.189 m deep.
  EXPECT_NEAR(sea.water(afloat), 1.96 * 0.96 * 0.169, 5e-3);
  EXPECT_GT(middleOf(afloat), -0.5);
  EXPECT_TRUE(sea.of(body).vessel->has_sunk);
  sea.scene.fluid.restore(sea.scene.fluid.save());
  sea.scene.step(1 / 60.0, 60);
  EXPECT_EQ(sea.scene.said.size(), 2u);
  sea.scene.fluid.restore(before);
  EXPECT_FALSE(sea.of(body).vessel->has_sunk);
}

// A hatch over the rim: awash, a barge takes no water before it opens.
TEST(Vessel, HatchKeepsTheSeaOut) {
  Sea sea;
  Start start;
  start.mass = 900;
  btRigidBody& body = sea.add({}, start, {true, {0}});
  const Immersed barge = sea.scene.of(body);
  barge.setOpening(0, 0, false);
  for (int i = 0; i < 20; ++i) {
    body.applyCentralForce({0, 0, bt(-150 * kGravity)});
    sea.scene.step(1 / 60.0);
  }
  sea.scene.step(1 / 60.0, 600);
  EXPECT_EQ(sea.water(body), 0);
  EXPECT_GT(middleOf(body), -0.25);
  barge.setOpening(0, 0, true);
  barge.addOpening(0, {0, 0.48, -0.1}, {0, 1, 0}, 0.01);  // a scupper under water
  sea.scene.step(1 / 60.0, 600);
  EXPECT_DOUBLE_EQ(sea.water(body), kCapacity);
}

// What a shut door keeps apart comes level when it opens.
TEST(Vessel, DoorBetweenHoldsIsShutAndOpened) {
  OpenBarge barge;
  barge.holds = 2;
  barge.door = 0.01;
  Sea sea;
  btRigidBody& body = sea.add(barge, {}, {true, {0.05, 0}});
  const Immersed boat = sea.scene.of(body);
  boat.setOpening(0, 1, false);
  sea.scene.step(1 / 60.0, 120);
  EXPECT_EQ(sea.water(body), 0.05);
  boat.setOpening(0, 1, true);
  sea.scene.step(1 / 60.0, 1200);
  EXPECT_LT(sea.water(body), 0.04);
  EXPECT_NEAR(sea.water(body) + boat.holds().at(1).volume, 0.05, 1e-12);
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
