// Bodies at the surface of water in a Bullet world.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/force/medium/waves.h"
#include "bullet_ambient/saved_state.h"
#include "tests/bullet_ambient/bullet/fluid_world.h"
#include "tests/bullet_ambient/bullet/state/state_scene.h"
#include "tests/support/bodies/part_bodies.h"
#include "tests/support/matrices.h"

namespace ambient::test {
namespace {

FluidRegion seaAt(double level) {
  return seaUnderVacuum(std::make_shared<StillWater>(level, Vector3(0, 0, 1)));
}

/// A world with water, and boxes of one shape in it.
struct WaterWorld {
  explicit WaterWorld(const FluidRegion& water) : scene(water) { shape->name = "box"; }
  btRigidBody& addBox(double specific_gravity, const RigidState& start, const Medium& own = {}) {
    const double mass = specific_gravity * 1000 * kBoxSize.prod();
    btRigidBody& body = scene.add({mass, boxMoments(kBoxSize, mass), start, &box});
    scene.fluid.add(body, {shape, own});
    return body;
  }
  std::string bits() const { return motionBytes(scene.fluid); }
  SavedRun saved() {
    return {scene.fluid, [this] { scene.step(1.0 / 60); }};
  }

  btBoxShape box{btVector3(bt(0.4), bt(0.3), bt(0.2))};
  btBoxShape floor_shape{btVector3(9, 9, 1)};
  std::shared_ptr<FluidBody> shape = std::make_shared<FluidBody>(floatingBox(kBoxSize));
  SeaWorld scene;
};

RigidState at(double z) { return startAt({0, 0, z}); }

RigidState tumbling(double z) {
  RigidState state = at(z);
  state.orientation = Quaternion(0.9, 0.3, -0.2, 0.1).normalized();
  state.twist = {Vector3(1, 2, 0.5), Vector3(0.5, -0.3, 0)};
  return state;
}

TEST(WaterWorld, DryAndDeepBodiesMoveBitForBitAsInOneFluid) {
  for (const double level : {-50.0, 50.0}) {
    FluidRegion sea = seaAt(level);
    sea.above = air();
    WaterWorld near(sea), alone(seaAt(0));
    alone.scene.fluid.removeRegion(static_cast<RegionId>(0));
    const Medium own = level < 0 ? air() : seaAt(0).below;
    const btRigidBody& a = near.addBox(0.9, tumbling(0));
    const btRigidBody& b = alone.addBox(0.9, tumbling(0), own);
    for (int i = 0; i < 60; ++i) {
      near.scene.step(1.0 / 60);
      alone.scene.step(1.0 / 60);
      ASSERT_TRUE(moveAlike(a, b)) << level << ", " << i;
    }
    EXPECT_EQ(near.scene.of(a).inertia(), alone.scene.of(b).inertia());
    EXPECT_EQ(near.scene.fluid.counters().load_evaluations,
              alone.scene.fluid.counters().load_evaluations);
  }
}

TEST(WaterWorld, ABodyRestsOnTheGroundOfShallowWater) {
  WaterWorld water(seaAt(0.15));
  water.scene.add({0, Vector3::Zero(), at(-1), &water.floor_shape});
  const btRigidBody& body = water.addBox(0.8, at(0.3));
  water.scene.step(1.0 / 60, 600);
  EXPECT_NEAR(heightOf(body), 0.2, 0.02);
  EXPECT_GT(water.scene.fluid.counters().rows, 100);
  EXPECT_LT(body.getLinearVelocity().length(), bt(1e-3));
}

// Energy of a body on a ball joint above water, without loads: never above the initial value.
TEST(WaterWorld, APendulumThatDipsInGainsNoEnergy) {
  for (const double step : {1.0 / 30, 1.0 / 60, 1.0 / 240}) {
    WaterWorld water(seaAt(0));
    RigidState start = at(0.5);
    start.position.x() = 0.9;
    btRigidBody& body = water.addBox(1.3, start);
    water.scene.contents.take(
        std::make_unique<btPoint2PointConstraint>(body, btVector3(bt(-0.9), 0, 0)));
    double highest = -1e9;
    for (int i = 0; i < static_cast<int>(10 / step); ++i) {
      water.scene.step(step);
      if (i * step > 1) highest = std::max(highest, heightOf(body));
    }
    EXPECT_LT(highest, 0.5 + 1e-3) << step;
    EXPECT_LT(body.getLinearVelocity().length(), bt(0.2)) << step;
    EXPECT_EQ(water.scene.fluid.counters().rejected, 0);
  }
}

// A pile of boxes that fall into water onto each other.
struct FloatingPile : WaterWorld {
  FloatingPile() : WaterWorld(seaAt(0)) {
    for (int i = 0; i < 24; ++i) {
      RigidState start = tumbling(0.3 + 0.25 * i);
      start.position.x() = 0.5 * (i % 3);
      start.position.y() = 0.4 * ((i / 3) % 2);
      addBox(0.1 + 0.05 * i, start);
    }
  }
};

TEST(WaterWorld, GoesOnBitForBitFromASavedState) {
  for (const int before : {10, 60}) {
    FloatingPile run, other;
    for (WaterWorld* world : {static_cast<WaterWorld*>(&run), static_cast<WaterWorld*>(&other)})
      for (int i = 0; i < world->scene.world.getNumCollisionObjects(); ++i)
        world->scene.world.getCollisionObjectArray()[i]->forceActivationState(DISABLE_DEACTIVATION);
    run.scene.step(1.0 / 60, before);
    expectGoesOn(run.saved(), other.saved(), 60);
  }
}

// plane_B, the surface after the last step, has more digits than Bullet's pose.
TEST(WaterWorld, ASavedStateHasTheSurfaceThatABodyHasMet) {
  WaterWorld run(seaAt(0)), other(seaAt(0)), without(seaAt(0));
  for (WaterWorld* world : {&run, &other, &without}) world->addBox(0.4, tumbling(0.3));
  run.scene.step(1.0 / 60, 20);
  WorldState state = run.scene.fluid.save();
  ASSERT_TRUE(state.bodies[0].ambient->plane_B);
  other.scene.fluid.restore(state);
  EXPECT_TRUE(run.bits() == other.bits());
  state.bodies[0].ambient->plane_B.reset();
  without.scene.fluid.restore(state);
  for (WaterWorld* world : {&run, &other, &without}) world->scene.step(1.0 / 60, 20);
  EXPECT_TRUE(run.bits() == other.bits());
  // Bullet's pose in double is as exact.
  if (!kDouble) {
    EXPECT_FALSE(run.bits() == without.bits());
  }
}

// Compares a free body after 2 s of wind with one on a rail along the wind.
TEST(WaterWorld, WindBlowsOnBodiesThatJointsMove) {
  FluidRegion sea = seaAt(0);
  sea.above = air();
  sea.above->velocity = {10, 0, 0};
  WaterWorld free(sea), joined(sea);
  const btRigidBody& drifting = free.addBox(0.5, at(0));
  btRigidBody& body = joined.addBox(0.5, at(0));
  joined.scene.contents.take(railOf(body, {-9, 0, -9}, {9, 0, 9}, true));
  free.scene.step(1.0 / 60, 120);
  joined.scene.step(1.0 / 60, 120);
  const auto speed = static_cast<double>(drifting.getLinearVelocity().x());
  EXPECT_GT(joined.scene.fluid.counters().rows, 100);
  EXPECT_GT(speed, 0.05);
  EXPECT_NEAR(static_cast<double>(body.getLinearVelocity().x()), speed, 0.1 * speed);
}

// Wind in a sea beside a calm one, and in a sea that was calm when the body was attached.
TEST(WaterWorld, WindIsFeltWhateverTheFluidsOfOtherRegions) {
  FluidRegion calm = seaAt(0), windy = seaAt(0);
  calm.above = windy.above = air();
  windy.above->velocity = {10, 0, 0};
  calm.bounds = RegionBounds{{100, -100, -100}, {200, 100, 100}};
  WaterWorld beside(windy), later(calm);
  beside.scene.fluid.addRegion(calm);
  const btRigidBody& drifting = beside.addBox(0.5, at(0));
  const btRigidBody& surprised = later.addBox(0.5, at(0));
  later.scene.fluid.setRegion(RegionId{0}, windy);
  FluidRegion unnamed = seaAt(0);
  unnamed.above.reset();
  WaterWorld by_own(unnamed);
  const btRigidBody& blown = by_own.addBox(0.5, at(0), air());
  by_own.scene.of(blown).setMedium(*windy.above);
  for (WaterWorld* world : {&beside, &later, &by_own}) world->scene.step(1.0 / 60, 120);
  EXPECT_GT(static_cast<double>(drifting.getLinearVelocity().x()), 0.05);
  EXPECT_GT(static_cast<double>(surprised.getLinearVelocity().x()), 0.05);
  EXPECT_EQ(toVector3(blown.getLinearVelocity()), toVector3(drifting.getLinearVelocity()))
      << "by the wind that setMedium() has raised";
}

TEST(WaterWorld, FloatingBodiesSleepInStillWaterButNotOnASaddle) {
  WaterWorld water(seaAt(0));
  btRigidBody& flat = water.addBox(0.5, at(0.001));
  flat.forceActivationState(ACTIVE_TAG);
  RigidState on_its_side = at(0);
  on_its_side.position.x() = 3;
  on_its_side.orientation = Quaternion(std::sqrt(0.5), 0, std::sqrt(0.5), 0);
  btRigidBody& standing = water.addBox(0.5, on_its_side);
  standing.forceActivationState(ACTIVE_TAG);
  water.scene.step(1.0 / 60, 900);
  EXPECT_FALSE(flat.isActive());
  EXPECT_TRUE(standing.isActive());
  FluidRegion higher = seaAt(0.3);
  water.scene.fluid.setRegion(static_cast<RegionId>(0), higher);
  water.scene.step(1.0 / 60, 60);
  EXPECT_TRUE(flat.isActive());
  EXPECT_GT(heightOf(flat), 0.1);
}

TEST(WaterWorld, NobodySleepsInWaves) {
  FluidRegion sea = seaAt(0);
  sea.surface = std::make_shared<AiryWaves>(CalmSea{}, std::vector<WaveComponent>{});
  WaterWorld water(sea);
  btRigidBody& body = water.addBox(0.5, at(0));
  body.forceActivationState(ACTIVE_TAG);
  water.scene.step(1.0 / 60, 600);
  EXPECT_TRUE(body.isActive());
}

// A sea that flows by, with wind: what it gives along locked axes goes into the locks.
TEST(WaterWorld, NothingMovesABodyAlongLockedAxes) {
  FluidRegion sea = seaAt(0);
  sea.surface =
      std::make_shared<AiryWaves>(CalmSea{}, std::vector<WaveComponent>{{0.1, 2, {0.8, 0.6, 0}}});
  sea.below.velocity = {0.5, 0.2, 0};
  sea.above = air();
  sea.above->velocity = {5, 3, 0};
  WaterWorld water(sea);
  btRigidBody& held = water.addBox(0.5, at(0));
  held.setLinearFactor({0, 0, 0});
  held.setAngularFactor({0, 0, 0});
  RigidState aside = at(0);
  aside.position.y() = 5;
  btRigidBody& heaving = water.addBox(0.5, aside);
  heaving.setLinearFactor({0, 0, 1});
  heaving.setAngularFactor({0, 0, 0});
  double highest = 0;
  for (int i = 0; i < 1200; ++i) {
    water.scene.step(1.0 / 60);
    highest = std::max(highest, std::abs(heightOf(heaving)));
  }
  EXPECT_EQ(toVector3(held.getWorldTransform().getOrigin()), Vector3(0, 0, 0));
  EXPECT_EQ(toVector3(held.getLinearVelocity()), Vector3(0, 0, 0));
  EXPECT_EQ(held.getOrientation(), btQuaternion::getIdentity());
  EXPECT_EQ(static_cast<double>(heaving.getWorldTransform().getOrigin().x()), 0);
  EXPECT_EQ(static_cast<double>(heaving.getWorldTransform().getOrigin().y()), 5);
  EXPECT_EQ(heaving.getOrientation(), btQuaternion::getIdentity());
  EXPECT_NEAR(highest, 0.1, 0.03);  // with the wave
}

// A body small against a wave moves like the water at the surface. For the height a cos(theta),
// theta = k x - omega t, displacement along the wave is -a sin(theta).

/// A wave of slope 0.04; its length is a multiple of the box's.
struct LongWave {
  double number, frequency, amplitude;  ///< [1/m], [rad/s], [m]

  explicit LongWave(double boxes)
      : number(2 * kPi / (boxes * kBoxSize.x())),
        frequency(std::sqrt(kGravity * number)),
        amplitude(0.04 / number) {}
  double period() const { return 2 * kPi / frequency; }
};

/// Amplitude over the wave's amplitude, and phase ahead of the water's motion [rad].
struct Response {
  double size, phase;
};
struct Responses {
  Response heave, surge;
};

struct Track {
  double time_step;
  std::vector<double> time;
  std::vector<Vector3> position;
};

/// A box of half the water's density, released at the crest with the water's velocity; its motion
/// from the third to the twelfth period.
Track boxInWave(const LongWave& wave, double time_step) {
  SeaWorld scene(seaUnderVacuum(std::make_shared<AiryWaves>(
      CalmSea{}, std::vector<WaveComponent>{{wave.amplitude, wave.period(), {1, 0, 0}, 0}})));
  const RigidState start =
      startAt({0, 0, wave.amplitude}, {Vector3::Zero(), {wave.amplitude * wave.frequency, 0, 0}});
  const double mass = 500 * kBoxSize.prod();
  const btRigidBody& body = scene.add({mass, boxMoments(kBoxSize, mass), start, nullptr},
                                      floatingBox(kBoxSize), Medium{});
  Track track{time_step, {}, {}};
  const auto steps = [&](double periods) {
    return static_cast<int>(std::lround(periods * wave.period() / time_step));
  };
  for (int i = 1; i <= steps(12); ++i) {
    scene.step(time_step);
    if (i <= steps(2)) continue;
    track.time.push_back(i * time_step);
    track.position.push_back(toVector3(body.getWorldTransform().getOrigin()));
  }
  return track;
}

/// Fits place, drift, and cosine and sine of the wave at the drifting place, by least squares.
Responses responsesOf(const Track& track, const LongWave& wave) {
  const auto rows = static_cast<Eigen::Index>(track.time.size());
  Eigen::MatrixXd basis(rows, 4), moved(rows, 2);
  Eigen::MatrixXd fit = Eigen::MatrixXd::Zero(4, 2);
  for (int pass = 0; pass < 3; ++pass) {
    for (Eigen::Index i = 0; i < rows; ++i) {
      const double t = track.time[static_cast<std::size_t>(i)];
      const Vector3& p = track.position[static_cast<std::size_t>(i)];
      const double angle = wave.number * (fit(0, 0) + fit(1, 0) * t) - wave.frequency * t;
      basis.row(i) << 1, t, std::cos(angle), std::sin(angle);
      moved.row(i) << p.x(), p.z();
    }
    fit = leastSquares(basis, moved);
  }
  // Phase of time is opposite to theta.
  return {{fit.col(1).tail<2>().norm() / wave.amplitude, std::atan2(fit(3, 1), fit(2, 1))},
          {fit.col(0).tail<2>().norm() / wave.amplitude, std::atan2(fit(2, 0), -fit(3, 0))}};
}

Responses responsesTo(double boxes, double time_step) {
  const LongWave wave(boxes);
  return responsesOf(boxInWave(wave, time_step), wave);
}

// Measured, as in docs/water.md. Surge lags by half a step: the flow of each step is sampled at its
// start.
TEST(LongWave, ASmallBodyMovesAsTheWaterAtTheSurface) {
  for (const double boxes : {40.0, 281.0})
    for (const double step : {1.0 / 30, 1.0 / 60, 1.0 / 120}) {
      const Responses response = responsesTo(boxes, step);
      const double step_angle = LongWave(boxes).frequency * step;
      EXPECT_NEAR(response.heave.size, 1, 0.0015) << boxes << ", " << step;
      EXPECT_NEAR(response.surge.size, 0.9925, 0.0025) << boxes << ", " << step;
      EXPECT_NEAR(response.heave.phase, 0, 0.1 * step_angle) << boxes << ", " << step;
      EXPECT_NEAR(response.surge.phase, -0.4 * step_angle, 0.25 * step_angle)
          << boxes << ", " << step;
    }
}

}  // namespace
}  // namespace ambient::test
