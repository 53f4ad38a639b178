#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "bullet_ambient/bullet/world_state.h"
#include "bullet_ambient/force/airy_waves.h"
#include "bullet_ambient/tasks/thread_pool.h"
#include "tests/bullet_ambient/bullet/fluid_world.h"
#include "tests/support/floating_runs.h"
#include "tests/support/part_bodies.h"

// Bodies at the surface of water in a world.
namespace ambient::test {
namespace {

constexpr double kWorldGravity = 9.81;
const Vector3 kBoxSize(0.8, 0.6, 0.4);

Medium freshWater() { return {1000, 1e-3, {0, 0, 0}, {0, 0, 0}}; }

FluidRegion seaAt(double level) {
  FluidRegion sea;
  sea.below = freshWater();
  sea.surface = std::make_shared<StillWater>(level, Vector3(0, 0, 1));
  return sea;
}

/// A world with water, and boxes of one shape in it.
struct WaterWorld {
  explicit WaterWorld(const FluidRegion& water, TaskRunner* runner = nullptr) {
    fluid.world.getDispatchInfo().m_deterministicOverlappingPairs = true;
    fluid.world.setGravity({0, 0, bt(-kWorldGravity)});
    fluid.registry.setTaskRunner(runner);
    fluid.registry.addRegion(water);
    shape->name = "box";
  }
  btRigidBody& addBox(double specific_gravity, const RigidState& start, const Medium& own = {}) {
    BodyDef def;
    def.mass = specific_gravity * 1000 * kBoxSize.prod();
    const Vector3 q = kBoxSize.cwiseAbs2() * (def.mass / 12);
    def.moments = Vector3(q.y() + q.z(), q.z() + q.x(), q.x() + q.y());
    def.start = start;
    def.shape = &box;
    btRigidBody& body = fluid.add(def);
    AttachDef attach;
    attach.fluid_body = shape;
    attach.medium = own;
    attach.flow.law = law;
    fluid.registry.attach(body, attach);
    return body;
  }
  std::string bits() const {
    WorldState state = saveState(fluid.world, fluid.registry);
    state.pairs.clear();
    state.contacts.clear();
    return encodeState(state);
  }

  btBoxShape box{btVector3(bt(0.4), bt(0.3), bt(0.2))};
  btBoxShape floor_shape{btVector3(9, 9, 1)};
  std::shared_ptr<FluidBody> shape = std::make_shared<FluidBody>(floatingBox(kBoxSize));
  PressureLaw law = PressureLaw::kForm;  // boxes are flat
  FluidWorld fluid;
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

TEST(WaterWorld, ABoxFloatsAtTheDraughtOfItsWeight) {
  for (const double s : {0.2, 0.5, 0.8}) {
    WaterWorld water(seaAt(1.5));
    RigidState start = at(1.5);
    start.orientation = Quaternion(0.999, 0.03, 0.01, 0).normalized();
    const btRigidBody& body = water.addBox(s, start);
    water.fluid.step(1.0 / 60, 1800);
    EXPECT_NEAR(heightOf(body), 1.5 + 0.4 * (0.5 - s), 2e-3) << s;
    EXPECT_NEAR(static_cast<double>(body.getWorldTransform().getBasis()[2].z()), 1, 1e-3) << s;
    EXPECT_EQ(water.fluid.registry.counters().rejected, 0);
  }
}

// As the motion box has it, step by step.
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
  water.law = PressureLaw::kPublished;
  const btRigidBody& body = water.addBox(0.6, tumbling(0.5));
  for (int i = 0; i < 60; ++i) {
    alone.step(1.0 / 60);
    water.fluid.step(1.0 / 60);
  }
  const Vector3 position = toVector3(body.getWorldTransform().getOrigin());
  EXPECT_LT((position - alone.state.position).norm(), byPrecision(2e-3, 5e-3));
}

bool areSame(const btRigidBody& a, const btRigidBody& b) {
  return a.getWorldTransform() == b.getWorldTransform() &&
         a.getLinearVelocity() == b.getLinearVelocity() &&
         a.getAngularVelocity() == b.getAngularVelocity();
}

TEST(WaterWorld, DryAndDeepBodiesMoveBitForBitAsInOneFluid) {
  for (const double level : {-50.0, 50.0}) {
    FluidRegion sea = seaAt(level);
    sea.above = air();
    WaterWorld near(sea), alone(seaAt(0));
    alone.fluid.registry.removeRegion(static_cast<RegionId>(0));
    const Medium own = level < 0 ? air() : freshWater();
    const btRigidBody& a = near.addBox(0.9, tumbling(0));
    const btRigidBody& b = alone.addBox(0.9, tumbling(0), own);
    for (int i = 0; i < 60; ++i) {
      near.fluid.step(1.0 / 60);
      alone.fluid.step(1.0 / 60);
      ASSERT_TRUE(areSame(a, b)) << level << ", " << i;
    }
    EXPECT_EQ(near.fluid.registry.inertia(a), alone.fluid.registry.inertia(b));
    EXPECT_EQ(near.fluid.registry.counters().load_evaluations,
              alone.fluid.registry.counters().load_evaluations);
  }
}

TEST(WaterWorld, ABodyRestsOnTheGroundOfShallowWater) {
  WaterWorld water(seaAt(0.15));
  BodyDef floor{0, Vector3::Zero(), at(-1), &water.floor_shape};
  water.fluid.add(floor);
  const btRigidBody& body = water.addBox(0.8, at(0.3));
  water.fluid.step(1.0 / 60, 600);
  EXPECT_NEAR(heightOf(body), 0.2, 0.02);
  EXPECT_GT(water.fluid.registry.counters().rows, 100);
  EXPECT_LT(body.getLinearVelocity().length(), bt(1e-3));
}

// Energy of a body on a ball joint above the water, without loads: never more than at the start.
TEST(WaterWorld, APendulumThatDipsInGainsNoEnergy) {
  for (const double step : {1.0 / 30, 1.0 / 60, 1.0 / 240}) {
    WaterWorld water(seaAt(0));
    RigidState start = at(0.5);
    start.position.x() = 0.9;
    btRigidBody& body = water.addBox(1.3, start);
    btPoint2PointConstraint joint(body, btVector3(bt(-0.9), 0, 0));
    water.fluid.world.addConstraint(&joint);
    double highest = -1e9;
    for (int i = 0; i < static_cast<int>(10 / step); ++i) {
      water.fluid.step(step);
      if (i * step > 1) highest = std::max(highest, heightOf(body));
    }
    EXPECT_LT(highest, 0.5 + 1e-3) << step;
    EXPECT_LT(body.getLinearVelocity().length(), bt(0.2)) << step;
    EXPECT_EQ(water.fluid.registry.counters().rejected, 0);
    water.fluid.world.removeConstraint(&joint);
  }
}

// A pile of boxes that fall into water on each other.
struct FloatingPile : WaterWorld {
  explicit FloatingPile(TaskRunner* runner = nullptr) : WaterWorld(seaAt(0), runner) {
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
  alone.fluid.step(1.0 / 60, 150);
  EXPECT_GT(alone.fluid.registry.counters().rows, 100);
  EXPECT_EQ(alone.fluid.registry.counters().rejected, 0);
  ThreadPool pool(3);
  FloatingPile other(&pool);
  other.fluid.step(1.0 / 60, 150);
  EXPECT_TRUE(alone.bits() == other.bits());
}

TEST(WaterWorld, GoesOnBitForBitFromASavedState) {
  for (const int before : {10, 60}) {
    FloatingPile run, other;
    for (WaterWorld* world : {static_cast<WaterWorld*>(&run), static_cast<WaterWorld*>(&other)})
      for (int i = 0; i < world->fluid.world.getNumCollisionObjects(); ++i)
        world->fluid.world.getCollisionObjectArray()[i]->forceActivationState(DISABLE_DEACTIVATION);
    run.fluid.step(1.0 / 60, before);
    const WorldState state =
        decodeState(encodeState(saveState(run.fluid.world, run.fluid.registry)), "bytes",
                    [&](const std::string&) { return other.shape; });
    restoreState(state, other.fluid.world, other.fluid.registry);
    for (int i = 0; i < 60; ++i) {
      run.fluid.step(1.0 / 60);
      other.fluid.step(1.0 / 60);
      ASSERT_TRUE(run.bits() == other.bits()) << before << " and " << i;
    }
  }
}

// Where the last step left the surface, to more digits than the pose that Bullet keeps.
TEST(WaterWorld, ASavedStateHasTheSurfaceThatABodyHasMet) {
  WaterWorld run(seaAt(0)), other(seaAt(0)), without(seaAt(0));
  for (WaterWorld* world : {&run, &other, &without}) world->addBox(0.4, tumbling(0.05));
  run.fluid.step(1.0 / 60, 20);
  WorldState state = saveState(run.fluid.world, run.fluid.registry);
  ASSERT_TRUE(state.bodies[0].ambient->met_B);
  restoreState(state, other.fluid.world, other.fluid.registry);
  EXPECT_TRUE(run.bits() == other.bits());
  state.bodies[0].ambient->met_B.reset();
  restoreState(state, without.fluid.world, without.fluid.registry);
  for (WaterWorld* world : {&run, &other, &without}) world->fluid.step(1.0 / 60, 20);
  EXPECT_TRUE(run.bits() == other.bits());
  EXPECT_FALSE(run.bits() == without.bits());
}

TEST(WaterWorld, ABodyGoesWithTheCurrentAndAWaveThatIsLong) {
  FluidRegion stream = seaAt(0);
  stream.below.velocity = {0.7, 0, 0};
  WaterWorld water(stream);
  const btRigidBody& body = water.addBox(0.5, at(0));
  water.fluid.step(1.0 / 60, 1200);
  // By quadratic drag, as 1 / t.
  EXPECT_NEAR(static_cast<double>(body.getLinearVelocity().x()), 0.7, 0.1);

  FluidRegion sea = seaAt(0);
  CalmSea calm;
  sea.surface =
      std::make_shared<AiryWaves>(calm, std::vector<WaveComponent>{{0.5, 12, {1, 0, 0}, 0}});
  WaterWorld waves(sea);
  RigidState start = at(0.5);
  start.twist.linear = {0.5 * 2 * std::acos(-1.0) / 12, 0, 0};
  const btRigidBody& buoy = waves.addBox(0.5, start);
  double highest = -9, lowest = 9;
  for (int i = 0; i < 2880; ++i) {
    waves.fluid.step(1.0 / 60);
    if (i < 1440) continue;
    highest = std::max(highest, heightOf(buoy));
    lowest = std::min(lowest, heightOf(buoy));
  }
  EXPECT_NEAR(highest - lowest, 1, 0.03);
}

// In 2 s, free or on a rail along the wind.
TEST(WaterWorld, WindBlowsOnBodiesThatJointsMove) {
  FluidRegion sea = seaAt(0);
  sea.above = air();
  sea.above.velocity = {10, 0, 0};
  WaterWorld free(sea), joined(sea);
  const btRigidBody& drifting = free.addBox(0.5, at(0));
  btRigidBody& body = joined.addBox(0.5, at(0));
  btGeneric6DofConstraint rail(body, btTransform::getIdentity(), true);
  rail.setLinearLowerLimit({-9, 0, -9});
  rail.setLinearUpperLimit({9, 0, 9});
  rail.setAngularLowerLimit({0, 0, 0});
  rail.setAngularUpperLimit({0, 0, 0});
  joined.fluid.world.addConstraint(&rail);
  free.fluid.step(1.0 / 60, 120);
  joined.fluid.step(1.0 / 60, 120);
  const auto speed = static_cast<double>(drifting.getLinearVelocity().x());
  EXPECT_GT(joined.fluid.registry.counters().rows, 100);
  EXPECT_GT(speed, 0.05);
  EXPECT_NEAR(static_cast<double>(body.getLinearVelocity().x()), speed, 0.1 * speed);
  joined.fluid.world.removeConstraint(&rail);
}

// In a sea of its own, beside a calm one, or over one that was calm.
TEST(WaterWorld, WindIsFeltWhateverTheFluidsOfOtherRegions) {
  FluidRegion calm = seaAt(0), windy = seaAt(0);
  calm.above = windy.above = air();
  windy.above.velocity = {10, 0, 0};
  calm.bounds = RegionBounds{{100, -100, -100}, {200, 100, 100}};
  WaterWorld beside(windy), later(calm);
  beside.fluid.registry.addRegion(calm);
  const btRigidBody& drifting = beside.addBox(0.5, at(0));
  const btRigidBody& surprised = later.addBox(0.5, at(0));
  later.fluid.registry.setRegion(RegionId{0}, windy);
  for (WaterWorld* world : {&beside, &later}) world->fluid.step(1.0 / 60, 120);
  EXPECT_GT(static_cast<double>(drifting.getLinearVelocity().x()), 0.05);
  EXPECT_GT(static_cast<double>(surprised.getLinearVelocity().x()), 0.05);
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
  water.fluid.step(1.0 / 60, 900);
  EXPECT_FALSE(flat.isActive());
  EXPECT_TRUE(standing.isActive());
  FluidRegion higher = seaAt(0.3);
  water.fluid.registry.setRegion(static_cast<RegionId>(0), higher);
  water.fluid.step(1.0 / 60, 60);
  EXPECT_TRUE(flat.isActive());
  EXPECT_GT(heightOf(flat), 0.1);
}

TEST(WaterWorld, SaysNothingOfBodiesThatFloat) {
  WaterWorld water(seaAt(0));
  std::string said;
  water.fluid.registry.setReport([&](const std::string& text) { said = text; });
  water.addBox(0.1, at(-20));
  water.fluid.step(1.0 / 60);
  EXPECT_EQ(said, "");
}

TEST(WaterWorld, NobodySleepsInWaves) {
  FluidRegion sea = seaAt(0);
  sea.surface = std::make_shared<AiryWaves>(CalmSea{}, std::vector<WaveComponent>{});
  WaterWorld water(sea);
  btRigidBody& body = water.addBox(0.5, at(0));
  body.forceActivationState(ACTIVE_TAG);
  water.fluid.step(1.0 / 60, 600);
  EXPECT_TRUE(body.isActive());
}

TEST(WaterWorld, TheInertiaOfAFloatingBodyIsThatOfItsImmersion) {
  WaterWorld water(seaAt(0));
  btRigidBody& body = water.addBox(0.5, at(0));
  water.fluid.step(1.0 / 60, 2);
  const double dry = 0.5 * 1000 * kBoxSize.prod();
  const Matrix6 K = water.fluid.registry.inertia(body);
  EXPECT_GT(K(5, 5), 1.1 * dry);
  EXPECT_LT(K(5, 5), dry + 999 * water.shape->added_mass(5, 5));
}

}  // namespace
}  // namespace ambient::test
