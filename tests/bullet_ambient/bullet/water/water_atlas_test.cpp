#include "tests/bullet_ambient/bullet/water/water_atlas.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "tests/bullet_ambient/bullet/fluid_world.h"
#include "tests/bullet_ambient/bullet/water/water_run.h"
#include "tests/support/bodies/part_bodies.h"
#include "tests/support/convergence.h"
#include "tests/support/runs.h"

namespace ambient::test {
namespace {

TEST(WaterAtlas, FreeBodiesGainRoundingAtMost) {
  for (unsigned seed = 0; seed < runsOf(24); ++seed) {
    const WaterResult result = runWater({WaterSetting::kFree, Around::kWater, seed});
    EXPECT_TRUE(result.is_finite) << "seed " << seed;
    EXPECT_LT(result.over_earlier, byPrecision(1e-12, 1e-5)) << "seed " << seed;
  }
}

// Contacts and joints do work: docs/water_validation.md has the share of 600 runs above 1 %, on
// floors 12 %. These runs are held to it; without eq. (68a) three of 20 on joints to the world
// exceed it.
TEST(WaterAtlas, ContactsAndJointsRaiseTheEnergyOfFew) {
  struct Case {
    WaterSetting setting;
    unsigned runs;
    int most;
  };
  for (const auto& [setting, runs, most] :
       {Case{WaterSetting::kOnFloor, 100, 12}, Case{WaterSetting::kAtWall, 20, 1},
        Case{WaterSetting::kColliding, 20, 0}, Case{WaterSetting::kJoined, 20, 0},
        Case{WaterSetting::kTethered, 20, 0}, Case{WaterSetting::kPile, 6, 0},
        Case{WaterSetting::kTabled, 20, 0}, Case{WaterSetting::kSteep, 20, 0}}) {
    WaterTally tally;
    for (unsigned seed = 0; seed < runsOf(runs); ++seed)
      tally.add(runWater({setting, Around::kWater, seed}));
    EXPECT_EQ(tally.not_finite, 0) << nameOf(setting);
    EXPECT_LE(tally.rose_much, most) << nameOf(setting);
  }
}

// Results of water_steps_study: order 2.2, error 4e-3 at 1/30 s.
TEST(WaterSteps, HeaveOfABallConvergesWithOrderTwo) {
  const StepErrors errors = measureSteps(WaterMotion::kHeave, 0);
  EXPECT_LT(errors.deviations[0], 0.006);
  EXPECT_GT(errors.order, byPrecision(1.8, 1.2));
}

// Single step: impact falls at an unknown part of the step, hence order 1.
TEST(WaterSteps, EntryConvergesWithOrderOneAndSubstepsMakeLongStepsGood) {
  const StepErrors single = measureSteps(WaterMotion::kEntry, 1);
  EXPECT_GT(single.order, 0.6);
  EXPECT_GT(single.deviations[0], 0.1);
  for (const double deviation : measureSteps(WaterMotion::kEntry, 0).deviations)
    EXPECT_LT(deviation, 0.03);
}

// A cube of 1 cm at 1/60 s: its heave has a period of some ten steps.

constexpr double kEdge = 0.01, kStep = 1.0 / 60;

struct SmallCube {
  SmallCube(double specific_gravity, double height, double tilt = 0) : run(Around::kWater) {
    WaterBodyDef def;
    def.shape = WaterShape::kCube;
    def.size = kEdge;
    def.specific_gravity = specific_gravity;
    def.start.position.z() = height;
    def.start.orientation = Quaternion(Eigen::AngleAxisd(tilt, Vector3(1, 0.4, 0.2).normalized()));
    body = &run.add(def);
  }
  /// Largest rise of energy above any earlier value, over the run's scale.
  double settle(double time, double step = kStep) {
    EnergyRise rise(run.energy());
    for (int i = 0; i < std::lround(time / step); ++i) {
      run.step(step);
      rise.see(run.energy());
    }
    return rise.overEarlier() / run.energyScale();
  }
  long timesSaid(const std::string& text) const {
    return std::count_if(run.said().begin(), run.said().end(), [&](const std::string& said) {
      return said.find(text) != std::string::npos;
    });
  }
  /// Least and largest component of the vertical along the cube's edges.
  std::pair<double, double> uprightness() const {
    const Vector3 up = (readState(*body).orientation.conjugate() * Vector3::UnitZ()).cwiseAbs();
    return {up.minCoeff(), up.maxCoeff()};
  }

  WaterRun run;
  btRigidBody* body = nullptr;
};

// Flat below 0.2113 and above 0.7887 times water's density, corner up at 0.5; docs/water.md.
TEST(SmallCube, ComesToRestAsHydrostaticsSaysAndGainsNoEnergy) {
  for (const double specific_gravity : {0.1, 0.5, 0.9})
    for (const bool is_dropped : {false, true}) {
      SmallCube cube(specific_gravity, is_dropped ? 0.05 : 0.002, is_dropped ? 0.7 : 0.05);
      EXPECT_LT(cube.settle(60), byPrecision(1e-12, 1e-5)) << specific_gravity;
      const RigidState end = readState(*cube.body);
      EXPECT_NEAR(end.position.z(), kEdge * (0.5 - specific_gravity), 0.003 * kEdge);
      EXPECT_LT(end.twist.linear.norm(), 0.01 * std::sqrt(kGravity * kEdge));
      const auto [least, largest] = cube.uprightness();
      if (specific_gravity == 0.5) {
        EXPECT_NEAR(least, std::sqrt(1.0 / 3), 0.02);
      } else {
        EXPECT_GT(largest, 0.9998) << specific_gravity;
      }
    }
}

// A cube on a joint that allows vertical motion only.
struct CubeOnRail : SmallCube {
  CubeOnRail(double specific_gravity, double above_rest)
      : SmallCube(specific_gravity, kEdge * (0.5 - specific_gravity) + above_rest) {
    run.join(railOf(*body, {0, 0, -1}, {0, 0, 1}));
  }
  double lowest(double time, double step) {
    double least = 0;
    for (int i = 0; i < std::lround(time / step); ++i) {
      run.step(step);
      least = std::min(least, readState(*body).position.z());
    }
    return least;
  }
};

// Period of 3.4 steps: with explicit buoyancy the cube would jump out of the water.
TEST(SmallCube, StaysInTheWaterWhereAJointMovesItInLongSteps) {
  constexpr double kSpecificGravity = 0.1;
  CubeOnRail cube(kSpecificGravity, 1e-4);
  EXPECT_LT(cube.settle(10, 1.0 / 30), 1e-4);
  EXPECT_NEAR(readState(*cube.body).position.z(), kEdge * (0.5 - kSpecificGravity), 0.01 * kEdge);
  EXPECT_EQ(cube.timesSaid("less than four steps a period"), 1);
}

// A cube with locked axes that allow vertical motion only.
struct LockedCube : SmallCube {
  LockedCube(double specific_gravity, double above_rest)
      : SmallCube(specific_gravity, kEdge * (0.5 - specific_gravity) + above_rest) {
    body->setLinearFactor({0, 0, 1});
    body->setAngularFactor({0, 0, 0});
  }
};

struct Gains {
  double most = 0, removed = 0;  // over WaterRun::energyScale(): largest; mean
};
// Gains of cubes that rise from 26 depths into air within a few steps, and fall back.
template <class Cube>
Gains gainsOf(double specific_gravity, double hertz) {
  Gains gains;
  constexpr int kDepths = 26;
  for (int i = 0; i < kDepths; ++i) {
    Cube cube(specific_gravity, kEdge * (specific_gravity - 1 - 0.1 * i));
    gains.most = std::max(gains.most, cube.settle(1, 1 / hertz));
    gains.removed += cube.run.counters().energy_removed / cube.run.energyScale() / kDepths;
  }
  return gains;
}

// Cubes give back the energy that buoyancy did not have, eq. (68a), also those that the water
// settles within a step, and none falls deeper than its energy reaches, eq. (68c). In less than
// four steps a period some is left: (68a) has the force without the stiffness of eq. (68).
TEST(SmallCube, GainsNothingWhereItPassesTheSurfaceWithRows) {
  for (const double specific_gravity : {0.1, 0.3, 0.5, 0.8})
    for (const double hertz : {30.0, 60.0, 240.0}) {
      const bool is_coarse = hertz < 60 || (hertz < 240 && specific_gravity < 0.3);
      const double coarse = hertz < 60 ? 0.03 : 1e-4;
      const double most = is_coarse ? coarse : byPrecision(1e-9, 1e-5);
      const Gains on_rail = gainsOf<CubeOnRail>(specific_gravity, hertz);
      const Gains locked = gainsOf<LockedCube>(specific_gravity, hertz);
      EXPECT_LT(on_rail.most, most) << specific_gravity << ", " << hertz << " Hz";
      EXPECT_LT(locked.most, most) << specific_gravity << ", " << hertz << " Hz";
      EXPECT_GT(on_rail.removed, 0.01) << specific_gravity;
      EXPECT_GT(locked.removed, 0.01) << specific_gravity;
    }
}

// Period of 10 steps. Difference for a free cube, which takes substeps: 0.001.
TEST(SmallCube, SwingsByATenthTooLittleWhereAJointMovesIt) {
  constexpr double kStart = 5e-4;
  CubeOnRail cube(0.5, kStart), fine(0.5, kStart);
  const double swing = cube.lowest(0.15, kStep) / kStart;
  EXPECT_NEAR(swing - fine.lowest(0.15, 1.0 / 960) / kStart, 0.09, 0.03);
  EXPECT_EQ(cube.timesSaid("four steps"), 0);
}

constexpr double kDepth = 1.5;  // of the centre at the start [m]

/// Returns the height to which a body of 0.115 times the density of water leaps [m].
double leapOf(const FluidBody& shape, double hertz, bool is_on_rail = false) {
  SeaWorld world;
  BodyDef def;
  def.mass = 0.1146 * water().density * shape.volume;
  def.moments.setConstant(0.1 * def.mass);
  def.start.position.z() = -kDepth;
  btRigidBody& body = world.add(def, shape, Medium{});
  if (is_on_rail) world.contents.take(railOf(body, {0, 0, -10}, {0, 0, 10}));
  double before = -kDepth, now = -kDepth;
  for (double time = 0; time < 3; time += 1 / hertz) {
    world.step(1 / hertz);
    const double next = heightOf(body);
    // The apex of the parabola through three heights.
    if (next < now && now > 0)
      return now - (next - before) * (next - before) / (8 * (before - 2 * now + next));
    before = now;
    now = next;
  }
  return 0;
}

TEST(Leap, IsAsHighAtStepsOfGamesAsAtShortOnes) {
  const FluidBody shapes[] = {floatingBall(0.5), floatingBox({0.8, 0.8, 0.8}),
                              floatingBox({0.6, 0.6, 1})};
  for (const FluidBody& shape : shapes) {
    const double limit = leapOf(shape, 2000);
    EXPECT_GT(limit, 0.5);
    for (const double hertz : {30, 60, 75, 144, 240})
      EXPECT_NEAR(leapOf(shape, hertz), limit, 0.03 * limit) << shape.volume << ", " << hertz;
  }
}

// With buoyancy taken back in the inertia where the step ended: 7.5 % too low at 30 Hz.
TEST(Leap, OfABallOnARailIsAsHigh) {
  const FluidBody ball = floatingBall(0.5);
  const double limit = leapOf(ball, 2000, true);
  for (const double hertz : {30, 60, 75, 144, 240})
    EXPECT_NEAR(leapOf(ball, hertz, true), limit, 0.03 * limit) << hertz;
}

}  // namespace
}  // namespace ambient::test
