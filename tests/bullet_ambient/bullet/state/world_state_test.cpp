#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <tuple>

#include "bullet_ambient/saved_state.h"
#include "tests/bullet_ambient/bullet/state/state_scene.h"

namespace ambient::test {
namespace {

constexpr int kBefore = 75, kAfter = 120;

// Disables sleep: times of falling asleep and waking depend on a longer past.
struct NobodySleeps {
  NobodySleeps() { gDisableDeactivation = true; }
  ~NobodySleeps() { gDisableDeactivation = false; }
};

struct Recording {
  NobodySleeps meanwhile;
  StateScene scene;
  WorldState state;
  std::vector<std::string> motions;

  explicit Recording(int before = kBefore) {
    scene.step(before);
    state = scene.scene.fluid.save();
    motions = record(scene.saved(), kAfter);
  }
};

TEST(WorldState, SavingChangesNothing) {
  StateScene saved, other;
  for (int i = 0; i < 50; ++i) {
    saved.scene.fluid.save();
    saved.step(1);
    other.step(1);
  }
  EXPECT_EQ(saved.motion() == other.motion(), true);
}

// Saves and restores in several phases of the pile; contacts begin and end in between.
TEST(WorldState, TheSameWorldAndOneBuiltByTheSameCodeGoOnBitForBit) {
  const NobodySleeps meanwhile;
  for (const int before : {1, 30, 60, 75, 100, 240}) {
    SCOPED_TRACE(before);
    StateScene run, other;
    run.step(before);
    const WorldState state = run.scene.fluid.save();
    expectGoesOn(run.saved(), other.saved(), kAfter);
    run.scene.fluid.restore(state);
    expectGoesOn(run.saved(), run.saved(), kAfter);
  }
}

TEST(WorldState, ChangesOfBodiesFluidsAndJointsAreTakenBack) {
  Recording run;
  StateScene& scene = run.scene;
  Fluid& fluid = scene.scene.fluid;
  fluid.find(scene.body(1))->remove();
  fluid.find(scene.body(2))->setMedium(air());
  fluid.find(scene.body(3))->setFluidBody(std::make_shared<FluidBody>(scaled(*scene.box_fluid, 2)));
  scene.body(4).setMassProps(99, btVector3(3, 4, 5));
  scene.body(5).setLinearFactor(btVector3(1, 0, 1));
  scene.body(6).applyCentralForce(btVector3(100, 0, 0));
  scene.body(7).setGravity(btVector3(0, 5, 0));
  scene.scene.contents.joints()[1]->setEnabled(false);
  fluid.add(scene.body(scene.scene.world.getNumCollisionObjects() - 1),
            {scene.ball_fluid, water()});
  scene.scene.fluid.restore(run.state);
  EXPECT_EQ(fluid.size(), 12u);
  EXPECT_EQ(fluid.find(scene.body(2))->medium().density, water().density);
  expectSameMotion(run.motions, record(scene.saved(), kAfter));
}

// Leapfrog memory and contact caches: omission of either must change the motion.
TEST(WorldState, TheCachesMatter) {
  for (const bool without_flight : {false, true}) {
    Recording run(kBefore);
    for (BodyState& body : run.state.bodies) {
      if (body.ambient && without_flight) body.ambient->memory = {};
    }
    if (!without_flight) {
      for (ContactState& contact : run.state.contacts) contact.points.clear();
    }
    run.scene.scene.fluid.restore(run.state);
    run.scene.step(1);
    EXPECT_NE(run.motions[0] == run.scene.motion(), true);
  }
}

// A body that lands beside a sleeping one may wake it at another time: btDbvtBroadphase's margins
// depend on a longer past.
TEST(WorldState, SleepingBodiesSleepOnAndAreWokenAsBefore) {
  StateScene scene;
  scene.step(1500);
  ASSERT_EQ(scene.body(1).getActivationState(), ISLAND_SLEEPING);
  const WorldState state = scene.scene.fluid.save();
  const auto wake = [](StateScene& s) {
    s.step(5);
    s.body(3).activate();
    s.body(3).setLinearVelocity(btVector3(0, 0, 2));
    return record(s.saved(), 8);
  };
  const auto motions = wake(scene);
  scene.scene.fluid.restore(state);
  EXPECT_EQ(scene.body(1).getActivationState(), ISLAND_SLEEPING);
  expectSameMotion(motions, wake(scene));
  StateScene other;
  other.scene.fluid.restore(state);
  expectSameMotion(motions, wake(other));
}

// Two touching dynamic bodies. Their joint disables collision, but the last contact points stay
// active.
TEST(WorldState, BodiesThatWereJoinedInContactGoOnBitForBit) {
  const NobodySleeps meanwhile;
  StateScene scene;
  scene.step(75);
  btRigidBody *a = nullptr, *b = nullptr;
  for (int i = 0; i < scene.scene.dispatcher.getNumManifolds(); ++i) {
    const btPersistentManifold& manifold = *scene.scene.dispatcher.getManifoldByIndexInternal(i);
    if (manifold.getNumContacts() == 0) continue;
    if (manifold.getBody0()->isStaticObject() || manifold.getBody1()->isStaticObject()) continue;
    a = &scene.body(manifold.getBody0()->getWorldArrayIndex());
    b = &scene.body(manifold.getBody1()->getWorldArrayIndex());
  }
  ASSERT_NE(a, nullptr);
  const btTransform to_b = b->getWorldTransform().inverse() * a->getWorldTransform();
  scene.scene.contents.join(
      std::make_unique<btPoint2PointConstraint>(*a, *b, btVector3(0, 0, 0), to_b.getOrigin()));
  scene.step(5);
  const WorldState state = scene.scene.fluid.save();
  const auto motions = record(scene.saved(), kAfter);
  scene.scene.fluid.restore(state);
  expectSameMotion(motions, record(scene.saved(), kAfter));
}

// Tables with four legs fall on a floor and on each other; each instance is built in the same way.
struct Tables : FluidWorld {
  explicit Tables(int seed) {
    world.getDispatchInfo().m_deterministicOverlappingPairs = true;
    world.setGravity({0, 0, bt(-9.81)});
    const auto at = [](double x, double y, double z) {
      return btTransform(btQuaternion::getIdentity(), {bt(x), bt(y), bt(z)});
    };
    table.addChildShape(at(0, 0, 0), &top);
    for (const double x : {-0.25, 0.25})
      for (const double y : {-0.16, 0.16}) table.addChildShape(at(x, y, -0.17), &leg);
    BodyDef def{0, Vector3::Zero(), startAt({0, 0, -0.5}), &floor};
    add(def);
    def = {8, Vector3(0.15, 0.3, 0.4), {}, &table};
    for (int i = 0; i < 6; ++i) {
      def.start.position = {0.05 * i, 0.08 * std::sin(2 * i), 0.6 + 0.45 * i};
      def.start.orientation =
          Eigen::AngleAxisd(0.7 * i + 0.37 * seed, Vector3(0.3 * i, 1, 0.2).normalized());
      def.start.twist.angular = {0.5 * std::sin(i), 0.3, 0.2 * i};
      add(def);
    }
  }

  btBoxShape floor{{10, 10, bt(0.5)}};
  btBoxShape top{{bt(0.3), bt(0.2), bt(0.02)}}, leg{{bt(0.02), bt(0.02), bt(0.15)}};
  btCompoundShape table;
};

// Parts that touch, and in how many points.
std::map<std::tuple<int, int, int, int>, std::size_t> touchingParts(const WorldState& state) {
  std::map<std::tuple<int, int, int, int>, std::size_t> parts;
  for (const ContactState& contact : state.contacts)
    if (!contact.points.empty())
      parts[{contact.pair.object_a, contact.pair.object_b, contact.points[0].m_index0,
             contact.points[0].m_index1}] += contact.points.size();
  return parts;
}

TEST(WorldState, HasAllContactsOfThePartsOfCompounds) {
  std::size_t touching = 0;
  for (int seed = 0; seed < 8; ++seed) {
    Tables tables(seed), others(seed);
    for (int i = 0; i < 12; ++i) {
      tables.step(kSceneStep, 15);
      const WorldState state = tables.fluid.save();
      others.fluid.restore(state);
      const auto parts = touchingParts(state);
      touching += parts.size();
      EXPECT_EQ(touchingParts(others.fluid.save()), parts) << seed << ", " << i;
    }
  }
  EXPECT_GT(touching, 500u);
}

TEST(WorldState, RefusesAWorldOfOtherBodiesOrJoints) {
  Recording run(5);
  const std::string before = run.scene.motion();
  WorldState fewer = run.state;
  fewer.bodies.pop_back();
  EXPECT_THROW(run.scene.scene.fluid.restore(fewer), std::invalid_argument);
  fewer = run.state;
  fewer.joints.pop_back();
  EXPECT_THROW(run.scene.scene.fluid.restore(fewer), std::invalid_argument);
  fewer = run.state;
  fewer.bodies[3].ambient->def.fluid_body = nullptr;
  EXPECT_THROW(run.scene.scene.fluid.restore(fewer), std::invalid_argument);
  EXPECT_EQ(run.scene.motion() == before, true);
}

}  // namespace
}  // namespace ambient::test
