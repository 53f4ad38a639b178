// Numbers by docs/theory.md section 20 and naval architects' formulas.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/motion/surface/hold_exchange.h"
#include "tests/bullet_ambient/motion/surface/barge_runs.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/bodies/vessel_bodies.h"

namespace ambient {
namespace {

using test::FloatingDef;
using test::FloatingRun;
using test::openBarge;
using namespace test::barge;

/// Torque of weight and water about x, over the weight [m].
double leverOf(const FloatingRun& run) {
  const Flotation flotation = run.flotation();
  return hydrostaticWrench(wetVolume(run.model(), flotation), flotation.plane).torque.x() /
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
    EXPECT_EQ(isStable(run.model(), run.flotation()), height > 0);
  }
}

// tan^2 = -2 GM / (BM_o - BM_i) of wall-sided holds.
TEST(HoldWater, TopHeavyBargeLollsToTheKnownAngle) {
  for (const auto& [centre, degrees] : {std::pair(0.2385, 7.0501), {0.24, 11.6314}}) {
    FloatingRun run(bargeDef(centre));
    run.water = {{0.2}};
    setAfloat(run, centre, 0);
    EXPECT_FALSE(isStable(run.model(), run.flotation())) << "upright";
    double low = 0.01, high = 0.3;
    for (int i = 0; i < 50; ++i) {
      const double heel = (low + high) / 2;
      setAfloat(run, centre, heel);
      (leverOf(run) > 0 ? low : high) = heel;
    }
    EXPECT_NEAR(low * 180 / kPi, degrees, 1e-4);
    EXPECT_TRUE(isStable(run.model(), run.flotation())) << "at the angle of loll";
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
  const WetVolume wet = wetVolume(run.model(), run.flotation());
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

// A cup of 0.14 x 0.14 m whose room is 0.2 m deep, in water of 1000 kg/m^3 below air of 101325 Pa.

using test::energyOfAir;
using test::OpenBarge;

constexpr double kAir = 101325, kWeight = 9810, kDeep = 0.2, kRim = 0.101, kSide = 0.136;

OpenBarge cup() {
  OpenBarge def;
  def.size = {0.14, 0.14, 0.202};
  def.wall = 0.002;
  return def;
}

/// The surface where the cup's rim has a depth; `tilt`: of the cup about x, from upright [rad].
SurfacePlane planeOver(double depth, double tilt) {
  const Vector3 normal(0, std::sin(tilt), std::cos(tilt));
  return {normal, normal.dot(Vector3(0, 0, kRim)) + depth, 1000, 9.81};
}

/// Column of air of a depth L that is pushed under, mouth down: p_0 L = (p_0 + rho g (d - L + x))
/// x.
double columnAt(double depth) {
  const double outside = kAir / kWeight, b = outside + depth - kDeep;
  return (std::sqrt(b * b + 4 * outside * kDeep) - b) / 2;
}

/// Energy of the water in the holds and of the air over it, docs/theory.md eq. (135), (148) [J].
double energyOf(const HoldShapes& holds, const SurfacePlane& plane,
                const std::vector<HoldState>& water) {
  double energy = kWeight * waterInside(holds, water.data(), plane, {}, 1000).below.depth_integral;
  for (std::size_t i = 0; i < water.size(); ++i)
    energy += water[i].is_sealed
                  ? energyOfAir(water[i].air, holds.shapes[i].capacity() - water[i].volume, kAir)
                  : 0;
  return energy;
}

TEST(SealedHolds, AirOfABellIsPressedTogetherByBoylesLaw) {
  const HoldShapes holds(openBarge(cup()).holds);
  const double area = kSide * kSide;
  for (const auto& [depth, column] :
       {std::pair(0.05, 0.199055), {1, 0.182626}, {10, 0.102109}, {100, 0.018754}}) {
    EXPECT_NEAR(columnAt(depth), column, 1e-6);
    for (const double step : {1 / 240.0, 1 / 60.0, 1 / 30.0}) {
      std::vector<HoldState> water(1);
      for (int i = 0; i < 400; ++i)
        exchangeWater(holds, planeOver(depth, kPi), {true, step}, water.data());
      EXPECT_TRUE(water[0].is_sealed);
      EXPECT_NEAR(water[0].air, kAir * kDeep * area, 1e-12 * kAir);
      EXPECT_NEAR(kDeep - water[0].volume / area, columnAt(depth), 1e-9) << depth << ' ' << step;
    }
  }
}

TEST(SealedHolds, BellThatIsLiftedGivesItsWaterBack) {
  const HoldShapes holds(openBarge(cup()).holds);
  std::vector<HoldState> water(1);
  for (const double depth : {0.1, 1.0, 5.0, 5.0, 1.0, 0.2, 0.05})
    for (int i = 0; i < 400; ++i)
      exchangeWater(holds, planeOver(depth, kPi), {true, 1 / 60.0}, water.data());
  EXPECT_NEAR(kDeep - water[0].volume / (kSide * kSide), columnAt(0.05), 1e-9);
  for (int i = 0; i < 100; ++i)
    exchangeWater(holds, planeOver(-0.01, kPi), {true, 1 / 60.0}, water.data());
  EXPECT_EQ(water[0].volume, 0);
  EXPECT_FALSE(water[0].is_sealed);
}

TEST(SealedHolds, TankInTheAirKeepsItsOwn) {
  std::vector<Hold> tank = openBarge(cup()).holds;
  tank[0].openings.clear();
  const HoldShapes holds(tank);
  std::vector<HoldState> water(1);
  water[0].volume = 0.3 * holds.shapes[0].capacity();
  exchangeWater(holds, planeOver(-1, 0), {true, 1 / 60.0}, water.data());
  EXPECT_TRUE(water[0].is_sealed);
  EXPECT_NEAR(water[0].air, kAir * 0.7 * holds.shapes[0].capacity(), 1e-12 * kAir);
}

// Air above the highest place of the mouth stays.
TEST(SealedHolds, TiltedBellKeepsTheAirAboveItsMouth) {
  const HoldShapes holds(openBarge(cup()).holds);
  for (const double hertz : {30.0, 60.0, 240.0}) {
    std::vector<HoldState> water(1);
    for (int i = 0; i < 200; ++i)
      exchangeWater(holds, planeOver(1, kPi), {true, 1 / 60.0}, water.data());
    const double tilt = 120 * kPi / 180;
    const SurfacePlane plane = planeOver(1, tilt);
    const double top = holds.openings[0].shape.top(plane.normal);
    const double above = holds.shapes[0].capacity() -
                         computeWetVolume(holds.shapes[0].hull(), {plane.normal, top, 0, 0}).volume;
    for (int i = 0; i < 2 * hertz; ++i)
      exchangeWater(holds, plane, {true, 1 / hertz}, water.data());
    const double air = holds.shapes[0].capacity() - water[0].volume;
    EXPECT_NEAR(air, above, 1e-3 * above) << hertz;
    EXPECT_LT(air, 0.9 * holds.shapes[0].capacity());
  }
}

// Bubbles of 0.35 sqrt(gD) through the mouth let the water in, or out of a cup in the air.
TEST(SealedHolds, WaterAndAirChangePlacesThroughAMouth) {
  const HoldShapes holds(openBarge(cup()).holds);
  const double area = kSide * kSide;
  const double rate = 0.35 * area * std::sqrt(9.81 * std::sqrt(4 * area / kPi));
  EXPECT_DOUBLE_EQ(bubblingFlow(holds.openings[0].shape, {}), rate);
  const double time = kDeep * area / rate;
  for (const double hertz : {30.0, 60.0, 240.0, 2000.0}) {
    std::vector<HoldState> in(1), out{{kDeep * area}};
    int steps_in = 0, steps_out = 0;
    for (; in[0].volume < kDeep * area && steps_in < 1e4; ++steps_in)
      exchangeWater(holds, planeOver(0.3, 0), {true, 1 / hertz}, in.data());
    // The depth presses 3 % in at once.
    EXPECT_NEAR(steps_in / hertz, time, 0.03 * time + 1.5 / hertz) << hertz;
    for (; out[0].volume > 0 && steps_out < 1e4; ++steps_out)
      exchangeWater(holds, planeOver(-1, kPi), {true, 1 / hertz}, out.data());
    // From where the orifice is slower, C sqrt(2gh) = U, the time is twice as long.
    const double speed = rate / area, low = speed * speed / (0.72 * 9.81);
    EXPECT_NEAR(steps_out / hertz, time + low / speed, 0.01 * time + 5 / hertz) << hertz;
  }
}

// A glass that is lifted mouth down out of a basin keeps its water while its mouth is under.
TEST(SealedHolds, AirOutsideHoldsTheWaterInALiftedGlass) {
  const HoldShapes holds(openBarge(cup()).holds);
  std::vector<HoldState> water{{holds.shapes[0].capacity()}};
  for (int i = 0; i < 600; ++i)
    exchangeWater(holds, planeOver(0.01, kPi), {true, 1 / 60.0}, water.data());
  EXPECT_NEAR(water[0].volume, holds.shapes[0].capacity(), 1e-15);
}

// A barge of two holds upside down, with a door at what was its floor: one pressure above.
TEST(SealedHolds, HoldsWithADoorAboveTheirWaterHaveOneAir) {
  OpenBarge def;
  def.holds = 2;
  def.door = 0.01;
  const HoldShapes holds(openBarge(def).holds);
  std::vector<HoldState> water{{0.1}, {0.02}};
  const SurfacePlane plane{{0, 0, -1}, 3, 1000, 9.81};
  const double capacity = holds.shapes[0].capacity();
  exchangeWater(holds, plane, {true, 1e-9}, water.data());
  const double product = kAir * (2 * capacity - 0.12);
  EXPECT_NEAR(water[0].air + water[1].air, product, 1e-9 * product);
  for (int i = 0; i < 1000; ++i) exchangeWater(holds, plane, {true, 1 / 60.0}, water.data());
  EXPECT_NEAR(water[0].volume, water[1].volume, 1e-9) << "level";
  EXPECT_NEAR(water[0].air + water[1].air, product, 1e-9 * product);
  const double air = capacity - water[0].volume;
  const double head = 3 - (-0.25 + water[0].volume / (capacity / 0.48));
  EXPECT_NEAR(product / (2 * air), kAir + kWeight * head, 1e-6 * kAir);
}

// A bulkhead without a door: each hold keeps its own air.
TEST(SealedHolds, HoldsApartHaveTheirOwnAir) {
  OpenBarge def;
  def.holds = 2;
  const HoldShapes holds(openBarge(def).holds);
  std::vector<HoldState> water{{0.2}, {0.0}};
  for (int i = 0; i < 1000; ++i)
    exchangeWater(holds, {{0, 0, -1}, 3, 1000, 9.81}, {true, 1 / 60.0}, water.data());
  EXPECT_GT(water[0].volume, water[1].volume + 0.1);
  EXPECT_LT(water[0].air, 0.6 * water[1].air);
}

TEST(SealedHolds, EnergyOfWaterAndAirNeverGrowsAndNoWaterIsMade) {
  test::Arbitrary arbitrary(21);
  int sealed = 0;
  for (int i = 0; i < 120; ++i) {
    OpenBarge def;
    def.holds = 1 + i % 3;
    def.door = i % 2 ? 0.01 : 0;
    def.hole = i % 5 == 0 ? 0.01 : 0;
    const HoldShapes holds(openBarge(def).holds);
    std::vector<HoldState> water(holds.shapes.size());
    for (std::size_t k = 0; k < water.size(); ++k)
      water[k].volume = holds.shapes[k].capacity() * std::max(0.0, arbitrary.between(-0.3, 1));
    const double step =
        std::array{1 / 240.0, 1 / 60.0, 1 / 30.0, 0.5}[static_cast<std::size_t>(i % 4)];
    for (int pose = 0; pose < 6; ++pose) {
      const SurfacePlane plane{arbitrary.vector().normalized(), arbitrary.between(-0.7, 2), 1000,
                               9.81};
      exchangeWater(holds, plane, {true, 0}, water.data());
      double energy = energyOf(holds, plane, water);
      for (int k = 0; k < 40; ++k) {
        double before = 0, come = 0, after = 0;
        for (const HoldState& hold : water) before += hold.volume;
        exchangeWater(holds, plane, {true, step}, water.data());
        for (const HoldState& hold : water) {
          after += hold.volume;
          come += hold.inflow;
          sealed += hold.is_sealed;
          ASSERT_GE(hold.volume, 0);
          ASSERT_GE(hold.air, 0);
        }
        for (std::size_t j = 0; j < water.size(); ++j)
          ASSERT_LE(water[j].volume, holds.shapes[j].capacity() * (1 + 1e-15));
        ASSERT_NEAR(after - before, come, 1e-14) << i << ' ' << pose << ' ' << k;
        const double next = energyOf(holds, plane, water);
        ASSERT_LT(next, energy + 1e-9) << i << ' ' << pose << ' ' << k << " step " << step;
        energy = next;
      }
    }
  }
  EXPECT_GT(sealed, 5000);
}

}  // namespace
}  // namespace ambient
