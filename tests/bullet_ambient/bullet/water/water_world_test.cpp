#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "bullet_ambient/force/medium/waves.h"
#include "bullet_ambient/saved_state.h"
#include "tests/bullet_ambient/bullet/fluid_world.h"
#include "tests/bullet_ambient/bullet/state/state_scene.h"
#include "tests/support/bodies/part_bodies.h"
#include "tests/support/floating_runs.h"
#include "tests/support/threads.h"

// Bodies at the surface of water in a Bullet world.
namespace ambient::test {
namespace {

Medium freshWater() { return {1000, 1e-3, {0, 0, 0}, {0, 0, 0}}; }

/// Under a vacuum, in which closed forms hold.
FluidRegion seaAt(double level) {
  FluidRegion sea;
  sea.below = freshWater();
  sea.above = Medium{};
  sea.surface = std::make_shared<StillWater>(level, Vector3(0, 0, 1));
  return sea;
}

/// A world with water, and boxes of one shape in it.
struct WaterWorld {
  explicit WaterWorld(const FluidRegion& water, const TaskRunner& runner = nullptr) {
    scene.world.getDispatchInfo().m_deterministicOverlappingPairs = true;
    scene.world.setGravity({0, 0, bt(-kGravity)});
    scene.fluid.setTaskRunner(runner);
    scene.fluid.addRegion(water);
    shape->name = "box";
  }
  btRigidBody& addBox(double specific_gravity, const RigidState& start, const Medium& own = {}) {
    BodyDef def;
    def.mass = specific_gravity * 1000 * kBoxSize.prod();
    const Vector3 q = kBoxSize.cwiseAbs2() * (def.mass / 12);
    def.moments = Vector3(q.y() + q.z(), q.z() + q.x(), q.x() + q.y());
    def.start = start;
    def.shape = &box;
    btRigidBody& body = scene.add(def);
    AttachDef attach;
    attach.fluid_body = shape;
    attach.medium = own;
    attach.flow.law = law;
    scene.fluid.add(body, attach);
    return body;
  }
  std::string bits() const { return motionBytes(scene.fluid); }
  SavedRun saved() {
    return {scene.fluid, [this] { scene.step(1.0 / 60); }};
  }

  btBoxShape box{btVector3(bt(0.4), bt(0.3), bt(0.2))};
  btBoxShape floor_shape{btVector3(9, 9, 1)};
  std::shared_ptr<FluidBody> shape = std::make_shared<FluidBody>(floatingBox(kBoxSize));
  PressureLaw law = PressureLaw::kForm;  // boxes are flat
  FluidWorld scene;
};

RigidState at(double z) {
  RigidState state;
  state.position = {0, 0, z};
  return state;
}

RigidState tumbling(double z) {
  RigidState state = at(z);
  state.orientation = Quaternion(0.9, 0.3, -0.2, 0.1).normalized();
  state.twist = {Vector3(1, 2, 0.5), Vector3(0.5, -0.3, 0)};
  return state;
}

double heightOf(const btRigidBody& body) {
  return static_cast<double>(body.getWorldTransform().getOrigin().z());
}

// Compares a free body step by step with the motion box's flight.
TEST(WaterWorld, AFreeBodyMovesAsTheFlightSays) {
  FloatingDef def;
  def.shape = floatingBox(kBoxSize);
  def.specific_gravity = 0.6;
  const Vector3 q = kBoxSize.cwiseAbs2() / 12;
  def.gyration = Vector3(q.y() + q.z(), q.z() + q.x(), q.x() + q.y()).cwiseSqrt();
  def.has_loads = true;
  FloatingRun alone(def);
  alone.state = tumbling(0.5);
  alone.state.twist.angular = alone.state.orientation.conjugate() * alone.state.twist.angular;
  alone.state.twist.linear = alone.state.orientation.conjugate() * alone.state.twist.linear;
  WaterWorld water(seaAt(0));
  const btRigidBody& body = water.addBox(0.6, tumbling(0.5));
  for (int i = 0; i < 60; ++i) {
    alone.step(1.0 / 60);
    water.scene.step(1.0 / 60);
  }
  const Vector3 position = toVector3(body.getWorldTransform().getOrigin());
  EXPECT_LT((position - alone.state.position).norm(), byPrecision(2e-3, 5e-3));
}

TEST(WaterWorld, DryAndDeepBodiesMoveBitForBitAsInOneFluid) {
  for (const double level : {-50.0, 50.0}) {
    FluidRegion sea = seaAt(level);
    sea.above = air();
    WaterWorld near(sea), alone(seaAt(0));
    alone.scene.fluid.removeRegion(static_cast<RegionId>(0));
    const Medium own = level < 0 ? air() : freshWater();
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
  BodyDef floor{0, Vector3::Zero(), at(-1), &water.floor_shape};
  water.scene.add(floor);
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
  explicit FloatingPile(const TaskRunner& runner = nullptr) : WaterWorld(seaAt(0), runner) {
    for (int i = 0; i < 24; ++i) {
      RigidState start = tumbling(0.3 + 0.25 * i);
      start.position.x() = 0.5 * (i % 3);
      start.position.y() = 0.4 * ((i / 3) % 2);
      addBox(0.1 + 0.05 * i, start);
    }
  }
};

TEST(WaterWorld, EndsWithTheSameBitsOnAnyNumberOfThreads) {
  FloatingPile alone;
  alone.scene.step(1.0 / 60, 150);
  EXPECT_GT(alone.scene.fluid.counters().rows, 100);
  EXPECT_EQ(alone.scene.fluid.counters().rejected, 0);
  FloatingPile other(onThreads(3));
  other.scene.step(1.0 / 60, 150);
  EXPECT_TRUE(alone.bits() == other.bits());
}

TEST(WaterWorld, GoesOnBitForBitFromASavedState) {
  for (const int before : {10, 60}) {
    FloatingPile run, other;
    for (WaterWorld* world : {static_cast<WaterWorld*>(&run), static_cast<WaterWorld*>(&other)})
      for (int i = 0; i < world->scene.world.getNumCollisionObjects(); ++i)
        world->scene.world.getCollisionObjectArray()[i]->forceActivationState(DISABLE_DEACTIVATION);
    run.scene.step(1.0 / 60, before);
    expectGoesOn(run.saved(), other.saved(), lookupOf(other.shape), 60);
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
  btGeneric6DofConstraint rail(body, btTransform::getIdentity(), true);
  rail.setLinearLowerLimit({-9, 0, -9});
  rail.setLinearUpperLimit({9, 0, 9});
  rail.setAngularLowerLimit({0, 0, 0});
  rail.setAngularUpperLimit({0, 0, 0});
  joined.scene.world.addConstraint(&rail);
  free.scene.step(1.0 / 60, 120);
  joined.scene.step(1.0 / 60, 120);
  const auto speed = static_cast<double>(drifting.getLinearVelocity().x());
  EXPECT_GT(joined.scene.fluid.counters().rows, 100);
  EXPECT_GT(speed, 0.05);
  EXPECT_NEAR(static_cast<double>(body.getLinearVelocity().x()), speed, 0.1 * speed);
  joined.scene.world.removeConstraint(&rail);
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

TEST(WaterWorld, TheInertiaOfAFloatingBodyIsThatOfItsImmersion) {
  WaterWorld water(seaAt(0));
  btRigidBody& body = water.addBox(0.5, at(0));
  water.scene.step(1.0 / 60, 2);
  const double dry = 0.5 * 1000 * kBoxSize.prod();
  const Matrix6 K = water.scene.of(body).inertia();
  EXPECT_GT(K(5, 5), 1.1 * dry);
  EXPECT_LT(K(5, 5), dry + 999 * water.shape->added_mass(5, 5));
}

}  // namespace
}  // namespace ambient::test
