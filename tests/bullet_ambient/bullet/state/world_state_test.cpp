#include "bullet_ambient/bullet/world_state.h"

#include <gtest/gtest.h>

#include "tests/bullet_ambient/bullet/state/state_scene.h"

namespace ambient::test {
namespace {

constexpr int kBefore = 75, kAfter = 120;

int contactPoints(StateScene& scene) {
  int count = 0;
  for (int i = 0; i < scene.fluid.dispatcher.getNumManifolds(); ++i) {
    count += scene.fluid.dispatcher.getManifoldByIndexInternal(i)->getNumContacts();
  }
  return count;
}

// Bits of the motion after each step.
std::vector<std::string> record(StateScene& scene, int steps) {
  std::vector<std::string> motions;
  for (int i = 0; i < steps; ++i) {
    scene.step(1);
    motions.push_back(scene.motion());
  }
  return motions;
}

void expectSame(const std::vector<std::string>& a, const std::vector<std::string>& b) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(a[i] == b[i], true) << "bits differ after step " << i + 1;
  }
}

// When a body falls asleep, and wakes others, depends on a longer past.
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
    state = saveState(scene.fluid.world, scene.fluid.registry);
    motions = record(scene, kAfter);
  }
};

TEST(WorldState, SavingChangesNothing) {
  StateScene saved, other;
  for (int i = 0; i < 50; ++i) {
    saveState(saved.fluid.world, saved.fluid.registry);
    saved.step(1);
    other.step(1);
  }
  EXPECT_EQ(saved.motion() == other.motion(), true);
}

// With contacts that come and go between saving and restoring, in several phases of the pile.
TEST(WorldState, TheSameWorldGoesOnBitForBit) {
  for (const int before : {1, 30, 60, 75, 100, 240}) {
    SCOPED_TRACE(before);
    Recording run(before);
    restoreState(run.state, run.scene.fluid.world, run.scene.fluid.registry);
    expectSame(run.motions, record(run.scene, kAfter));
  }
}

TEST(WorldState, AWorldBuiltByTheSameCodeGoesOnBitForBit) {
  for (const int before : {1, 30, 60, 75, 100, 240}) {
    SCOPED_TRACE(before);
    const Recording run(before);
    StateScene other;
    restoreState(run.state, other.fluid.world, other.fluid.registry);
    EXPECT_EQ(contactPoints(other) > 5, before >= 30);
    expectSame(run.motions, record(other, kAfter));
  }
}

TEST(WorldState, ChangesOfBodiesFluidsAndJointsAreTakenBack) {
  Recording run;
  StateScene& scene = run.scene;
  AmbientRegistry& registry = scene.fluid.registry;
  registry.detach(scene.body(1));
  registry.setMedium(scene.body(2), air());
  registry.setFluidBody(scene.body(3), std::make_shared<FluidBody>(scaled(*scene.box_fluid, 2)));
  scene.body(4).setMassProps(99, btVector3(3, 4, 5));
  scene.body(5).setLinearFactor(btVector3(1, 0, 1));
  scene.body(6).applyCentralForce(btVector3(100, 0, 0));
  scene.body(7).setGravity(btVector3(0, 5, 0));
  scene.joints[1]->setEnabled(false);
  AttachDef stone;
  stone.fluid_body = scene.ball_fluid;
  stone.medium = water();
  registry.attach(scene.body(scene.fluid.world.getNumCollisionObjects() - 1), stone);
  restoreState(run.state, scene.fluid.world, registry);
  EXPECT_EQ(registry.size(), 12u);
  EXPECT_EQ(registry.medium(scene.body(2)).density, water().density);
  expectSame(run.motions, record(scene, kAfter));
}

// What the leapfrog and the contacts remember cannot be left out.
TEST(WorldState, TheCachesMatter) {
  for (const bool without_flight : {false, true}) {
    Recording run(kBefore);
    for (BodyState& body : run.state.bodies) {
      if (body.ambient && without_flight) body.ambient->memory = {};
    }
    if (!without_flight) {
      for (ContactState& contact : run.state.contacts) contact.points.clear();
    }
    restoreState(run.state, run.scene.fluid.world, run.scene.fluid.registry);
    run.scene.step(1);
    EXPECT_NE(run.motions[0] == run.scene.motion(), true);
  }
}

// A body that lands later beside a sleeping one may wake it sooner or later than before: that
// depends on margins of btDbvtBroadphase, which have a longer past.
TEST(WorldState, SleepingBodiesSleepOnAndAreWokenAsBefore) {
  StateScene scene;
  scene.step(1500);
  ASSERT_EQ(scene.body(1).getActivationState(), ISLAND_SLEEPING);
  const WorldState state = saveState(scene.fluid.world, scene.fluid.registry);
  const auto wake = [](StateScene& s) {
    s.step(5);
    s.body(3).activate();
    s.body(3).setLinearVelocity(btVector3(0, 0, 2));
    return record(s, 8);
  };
  const auto motions = wake(scene);
  restoreState(state, scene.fluid.world, scene.fluid.registry);
  EXPECT_EQ(scene.body(1).getActivationState(), ISLAND_SLEEPING);
  expectSame(motions, wake(scene));
  StateScene other;
  restoreState(state, other.fluid.world, other.fluid.registry);
  expectSame(motions, wake(other));
}

// Two dynamic bodies that touch; their collision is switched off by the joint, which leaves their
// last contact points in force.
TEST(WorldState, BodiesThatWereJoinedInContactGoOnBitForBit) {
  const NobodySleeps meanwhile;
  StateScene scene;
  scene.step(75);
  btRigidBody *a = nullptr, *b = nullptr;
  for (int i = 0; i < scene.fluid.dispatcher.getNumManifolds(); ++i) {
    const btPersistentManifold& manifold = *scene.fluid.dispatcher.getManifoldByIndexInternal(i);
    if (manifold.getNumContacts() == 0) continue;
    if (manifold.getBody0()->isStaticObject() || manifold.getBody1()->isStaticObject()) continue;
    a = &scene.body(manifold.getBody0()->getWorldArrayIndex());
    b = &scene.body(manifold.getBody1()->getWorldArrayIndex());
  }
  ASSERT_NE(a, nullptr);
  const btTransform to_b = b->getWorldTransform().inverse() * a->getWorldTransform();
  scene.joints.push_back(
      std::make_unique<btPoint2PointConstraint>(*a, *b, btVector3(0, 0, 0), to_b.getOrigin()));
  scene.fluid.world.addConstraint(scene.joints.back().get(), true);
  scene.step(5);
  const WorldState state = saveState(scene.fluid.world, scene.fluid.registry);
  const auto motions = record(scene, kAfter);
  restoreState(state, scene.fluid.world, scene.fluid.registry);
  expectSame(motions, record(scene, kAfter));
}

TEST(WorldState, RefusesAWorldOfOtherBodiesOrJoints) {
  Recording run(5);
  const std::string before = run.scene.motion();
  WorldState fewer = run.state;
  fewer.bodies.pop_back();
  EXPECT_THROW(restoreState(fewer, run.scene.fluid.world, run.scene.fluid.registry),
               std::invalid_argument);
  fewer = run.state;
  fewer.joints.pop_back();
  EXPECT_THROW(restoreState(fewer, run.scene.fluid.world, run.scene.fluid.registry),
               std::invalid_argument);
  WorldState broken = run.state;
  broken.bodies[3].ambient->def.medium.density = -1;
  EXPECT_THROW(restoreState(broken, run.scene.fluid.world, run.scene.fluid.registry),
               std::invalid_argument);
  broken = run.state;
  broken.bodies[3].ambient->def.fluid_body = nullptr;
  EXPECT_THROW(restoreState(broken, run.scene.fluid.world, run.scene.fluid.registry),
               std::invalid_argument);
  broken = run.state;
  ASSERT_FALSE(broken.contacts.empty());
  broken.contacts[0].points.resize(100);
  EXPECT_THROW(restoreState(broken, run.scene.fluid.world, run.scene.fluid.registry),
               std::invalid_argument);
  EXPECT_EQ(run.scene.motion() == before, true);
}

}  // namespace
}  // namespace ambient::test
