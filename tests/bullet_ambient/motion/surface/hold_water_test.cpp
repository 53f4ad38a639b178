#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/motion/surface/hold_exchange.h"
#include "bullet_ambient/spatial/rotation.h"
#include "tests/bullet_ambient/motion/surface/barge_runs.h"
#include "tests/support/bodies/random_bodies.h"

// Numbers by docs/theory.md section 20 and naval architects' formulas.
namespace ambient {
namespace {

using test::FloatingDef;
using test::FloatingRun;
using test::openBarge;
using namespace test::barge;

/// Torque of weight and water about x, over the weight [m].
double leverOf(const FloatingRun& run) {
  const SurfaceStand stand = run.stand();
  return hydrostaticWrench(wetVolume(run.model(), stand), stand.plane).torque.x() /
         (kBargeMass * 9.81);
}

TEST(HoldWater, FreeSurfaceTakesItsPartOffTheMetacentricHeight) {
  constexpr double kCentre = 0.15673, kSmall = 1e-5;
  for (const double water : {0.0, 0.02, 0.1, 0.3, 0.6}) {
    FloatingRun run(bargeDef(kCentre));
    run.water = {{water}};
    setAfloat(run, kCentre, 0);
    const double volume = kBargeMass / 1000, draught = draughtOf(water);
    // Moments of the buoyancy and of the water inside about the centre of mass.
    const double outer =
        kBargeLength * std::pow(kBargeWidth, 3) / 12 + (volume + water) * (draught / 2 - kCentre);
    const double inner = (water > 0 ? 1.96 * std::pow(0.96, 3) / 12 : 0) +
                         water * (kBargeWall + water / kBargeInner / 2 - kCentre);
    const double height = (outer - inner) / volume;
    setAfloat(run, kCentre, kSmall);
    EXPECT_NEAR(-leverOf(run) / kSmall, height, 1e-6) << water;
    EXPECT_EQ(isStable(run.model(), run.stand()), height > 0);
  }
}

// tan^2 = -2 GM / (BM_o - BM_i) of wall-sided holds.
TEST(HoldWater, TopHeavyBargeLollsToTheKnownAngle) {
  for (const auto& [centre, degrees] : {std::pair(0.2385, 7.0501), {0.24, 11.6314}}) {
    FloatingRun run(bargeDef(centre));
    run.water = {{0.2}};
    setAfloat(run, centre, 0);
    EXPECT_FALSE(isStable(run.model(), run.stand())) << "upright";
    double low = 0.01, high = 0.3;
    for (int i = 0; i < 50; ++i) {
      const double heel = (low + high) / 2;
      setAfloat(run, centre, heel);
      (leverOf(run) > 0 ? low : high) = heel;
    }
    EXPECT_NEAR(low * 180 / kPi, degrees, 1e-4);
    EXPECT_TRUE(isStable(run.model(), run.stand())) << "at the angle of loll";
  }
}

// A vessel full of water deep below is the one that the medium alone moves.
TEST(HoldWater, FullVesselIsThatOfOneFluid) {
  const FloatingDef def = bargeDef(0.2);
  FloatingRun run(def);
  run.water = {{kCapacity}};
  run.state.position = {0, 0, -10};
  const MassProperties mass{kBargeMass, (kBargeMass * def.gyration.cwiseAbs2()).asDiagonal()};
  FrameOffset frame;
  frame.translation = -def.centre_of_mass;
  const BodyModel full =
      makeBodyModel(def.shape, frame, mass, {1000, 0, {0, 0, 0}, {0, 0, 0}}, nullptr);
  EXPECT_LT((run.inertia() - full.inertia).norm(), 1e-12 * full.inertia.norm());
  const WetVolume wet = wetVolume(run.model(), run.stand());
  EXPECT_NEAR(1000 * wet.volume, full.displaced_mass, 1e-9);
  EXPECT_LT((1000 * wet.moment - full.displaced_mass * full.centre_of_volume).norm(), 1e-9);
  EXPECT_TRUE(areFull(*run.model().holds, run.water.data()));
}

// Flow over the rim of an upright barge: Poleni's formula, section 8's 29.266 l/s.
TEST(HoldWater, WaterComesOverTheRimAndLevelsMeet) {
  FloatingRun run(bargeDef(0.2));
  std::vector<HoldState> water(1);
  const HoldShapes& holds = *run.model().holds;
  const SurfacePlane over{{0, 0, 1}, kBargeHeight / 2 + 0.02, 1000, 9.81};
  // Its air is pressed together first.
  for (int i = 0; i < 100; ++i) exchangeWater(holds, over, {true, 1e-3}, water.data());
  EXPECT_NEAR(water[0].volume, 100e-3 * 0.0293 + 0.02 * 9810 / 101325 * kCapacity, 3e-4)
      << "less what would have come meanwhile";
  const double before = water[0].volume;
  exchangeWater(holds, over, {true, 1e-3}, water.data());
  EXPECT_NEAR(water[0].inflow / 1e-3,
              2.0 / 3 * 0.6 * std::sqrt(2 * 9.81) * 5.84 * std::pow(0.02, 1.5), 1e-3 * 0.029);
  EXPECT_DOUBLE_EQ(water[0].volume, before + water[0].inflow);
  exchangeWater(holds, over, {false, 10}, water.data());
  EXPECT_EQ(water[0].inflow, 0) << "closed";
  for (int i = 0; i < 2000; ++i) exchangeWater(holds, over, {true, 0.1}, water.data());
  EXPECT_DOUBLE_EQ(water[0].volume, kCapacity);
}

// 1.96 (b d - b^2 tan / 2) of docs/theory.md's barge stays when it heels.
TEST(HoldWater, HeelEmptiesAHoldDownToItsRim) {
  const FluidBody barge = openBarge();
  const HoldShapes holds(barge.holds);
  for (const double degrees : {10.0, 20.0, 25.0}) {
    const double heel = degrees * kPi / 180;
    std::vector<HoldState> water{{0.9}};
    const SurfacePlane below{{0, -std::sin(heel), std::cos(heel)}, -5, 1000, 9.81};
    for (int i = 0; i < 3000; ++i) exchangeWater(holds, below, {true, 1 / 60.0}, water.data());
    const double left = 1.96 * (0.96 * 0.48 - 0.96 * 0.96 * std::tan(heel) / 2);
    EXPECT_GE(water[0].volume, left - 1e-12);
    EXPECT_NEAR(water[0].volume, left, 3e-3 * left) << "the flow ends as 1 / t^2";
  }
}

TEST(HoldWater, WaterPassesADoorAndItsSumStays) {
  test::OpenBarge def;
  def.holds = 2;
  def.door = 0.01;
  const FluidBody barge = openBarge(def);
  const HoldShapes holds(barge.holds);
  ASSERT_EQ(holds.shapes.size(), 2u);
  std::vector<HoldState> water{{0.3}, {0.1}};
  const SurfacePlane below{{0, 0, 1}, -5, 1000, 9.81};
  const double area = holds.shapes[0].capacity() / 0.48, head = 0.2 / area;
  // Heads fall as the square of the time, to a quarter in half of the time to level.
  const double half = std::sqrt(head) / (0.6 * 0.01 * std::sqrt(2 * 9.81) * 2 / area);
  double time = 0;
  while (water[0].volume - water[1].volume > 0.05) {
    exchangeWater(holds, below, {true, 1 / 240.0}, water.data());
    time += 1 / 240.0;
  }
  EXPECT_NEAR(time, half, 0.005 * half);
  EXPECT_NEAR(water[0].volume + water[1].volume, 0.4, 1e-14);
  EXPECT_EQ(water[0].inflow, 0);
}

TEST(HoldWater, PumpMovesNoMoreThanThereIs) {
  const FluidBody barge = openBarge();
  const HoldShapes holds(barge.holds);
  const SurfacePlane below{{0, 0, 1}, -5, 1000, 9.81};
  std::vector<HoldState> water(1);
  water[0].volume = 0.1;
  water[0].pump = -0.03;
  exchangeWater(holds, below, {true, 1}, water.data());
  EXPECT_DOUBLE_EQ(water[0].volume, 0.07);
  EXPECT_DOUBLE_EQ(water[0].inflow, -0.03);
  exchangeWater(holds, below, {true, 10}, water.data());
  EXPECT_EQ(water[0].volume, 0);
  water[0].pump = 1;
  exchangeWater(holds, below, {false, 10}, water.data());
  EXPECT_DOUBLE_EQ(water[0].volume, kCapacity);
}

}  // namespace
}  // namespace ambient
