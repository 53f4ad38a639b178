#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <stdexcept>

#include "tests/bullet_ambient/bullet/robots/state/robot_state_scene.h"
#include "tests/support/refusal_of.h"

// Saved states of worlds with robots.
namespace ambient::test {
namespace {

constexpr int kAfter = 90;
constexpr auto kNaN = std::numeric_limits<btScalar>::quiet_NaN();
constexpr auto kInfinity = std::numeric_limits<btScalar>::infinity();

std::string refusal(RobotStateScene& scene, const WorldState& state) {
  const std::string said = refusalOf<std::invalid_argument>([&] { scene.restore(state); });
  EXPECT_EQ(said.find('\n'), std::string::npos);
  return said;
}

TEST(RobotState, GoesOnBitForBitInTheSameWorldAndInOneBuiltByTheSameCode) {
  for (const RobotStateKind kind : kRobotStateKinds) {
    for (const int before : {0, 40, 133}) {
      SCOPED_TRACE(static_cast<int>(kind) * 1000 + before);
      RobotStateScene run(kind), other(kind);
      run.step(before);
      const WorldState state = run.save();
      expectGoesOn(run.saved(), other.saved(), kAfter, other.lookup());
      run.restore(state);
      expectGoesOn(run.saved(), run.saved(), kAfter, run.lookup());
    }
  }
}

// Bullet leaves the predicted positions of joints unset until the first step, which sets them
// before it reads them.
TEST(RobotState, HasNothingThatBulletHasNotSet) {
  for (const RobotStateKind kind : kRobotStateKinds) {
    RobotStateScene run(kind), other(kind);
    btMultiBody& robot = run.robot(0);
    for (int link = 0; link < robot.getNumLinks(); ++link)
      for (btScalar& position : robot.getLink(link).m_jointPos_interpolate) position = kNaN;
    const WorldState state = run.save();
    EXPECT_TRUE(encodeState(state) == encodeState(other.save()));
    EXPECT_EQ(refusal(run, state), "");
    expectSameMotion(other.record(kAfter), run.record(kAfter));
  }
}

TEST(RobotState, SavingChangesNothing) {
  for (const RobotStateKind kind : kRobotStateKinds) {
    RobotStateScene saved(kind), other(kind);
    saved.record(40);
    other.step(40);
    EXPECT_TRUE(saved.motion() == other.motion());
  }
}

// State besides positions and velocities: omission of any part must change the motion.
TEST(RobotState, WhatIsRememberedMatters) {
  struct Omission {
    RobotStateKind kind;
    std::function<void(WorldState&)> omit;
    const char* what;
  };
  const Omission omissions[] = {{RobotStateKind::kMotors,
                                 [](WorldState& s) {
                                   for (MultiBodyJointState& joint : s.multi_body_joints)
                                     joint.applied_impulses.clear();
                                 },
                                 "impulses of joints"},
                                {RobotStateKind::kContacts,
                                 [](WorldState& s) {
                                   for (ContactState& contact : s.contacts) contact.points.clear();
                                 },
                                 "contacts"},
                                {RobotStateKind::kContacts,
                                 [](WorldState& s) {
                                   for (MultiBodyState& body : s.multi_bodies)
                                     body.turn_reserve = 0;
                                 },
                                 "reserve"},
                                {RobotStateKind::kWater,
                                 [](WorldState& s) {
                                   for (MultiBodyState& body : s.multi_bodies)
                                     for (LinkFluidState& fluid : body.fluids)
                                       fluid.ambient.waves = {};
                                 },
                                 "waves that a link has made"},
                                {RobotStateKind::kSwimming,
                                 [](WorldState& s) {
                                   for (MultiBodyState& body : s.multi_bodies)
                                     for (LinkFluidState& fluid : body.fluids)
                                       fluid.ambient.memory = {};
                                 },
                                 "loads at the end of a flight"}};
  for (const Omission& omission : omissions) {
    SCOPED_TRACE(omission.what);
    RobotStateScene run(omission.kind);
    run.step(omission.kind == RobotStateKind::kWater ? 40 : 100);  // at the surface, on the floor
    WorldState state = run.save();
    const auto motions = run.record(kAfter);
    omission.omit(state);
    run.restore(state);
    EXPECT_FALSE(run.record(kAfter) == motions);
  }
}

// Loads are evaluated once in a step; twice in the first one, and after others have moved a robot.
TEST(RobotState, RobotsForgetLoadsWhenOthersMoveThem) {
  RobotStateScene run(RobotStateKind::kSwimming);
  btMultiBody& robot = run.robot(0);
  const auto evaluations = [&run, &robot](int steps) {
    const auto count = [&] { return run.fluid().find(robot, 1)->counters().load_evaluations; };
    const long long before = count();
    run.step(steps);
    return count() - before;
  };
  run.step(60);  // slower, in one substep each
  EXPECT_EQ(evaluations(3), 3);
  robot.setBaseVel(bt(1.01) * robot.getBaseVel());
  const WorldState state = run.save();
  EXPECT_EQ(evaluations(1), 2);
  const auto motions = run.record(kAfter);
  run.restore(state);
  EXPECT_EQ(evaluations(1), 2);
  expectSameMotion(motions, run.record(kAfter));
}

TEST(RobotState, ChangesAreTakenBack) {
  RobotStateScene run(RobotStateKind::kMotors);
  run.step(20);
  const WorldState state = run.save();
  const auto motions = run.record(kAfter);
  btMultiBody& robot = run.robot(0);
  Fluid& fluid = run.fluid();
  const AttachDef def = state.multi_bodies[0].fluids[0].ambient.def;
  fluid.find(robot, 1)->remove();
  fluid.find(robot, 0)->setMedium(idealFluid(7));
  fluid.add(run.robot(1), 2, def);
  robot.setBaseMass(9);
  robot.getLink(1).m_mass = 5;
  robot.setLinearDamping(1);
  robot.addLinkForce(2, {100, 0, 0});
  robot.addJointTorque(0, 3);
  robot.goToSleep();
  run.restore(state);
  EXPECT_FALSE(fluid.find(run.robot(1), 2));
  EXPECT_EQ(fluid.find(robot, 0)->medium().density, 1);
  expectSameMotion(motions, run.record(kAfter));
}

// Sleep timers are saved, though Bullet keeps them private.
TEST(RobotState, RobotsFallAsleepWhenTheyWouldHave) {
  const auto rest = [](RobotStateScene& scene) {
    for (int i = 0; i < 2; ++i) {
      btMultiBody& robot = scene.robot(i);
      robot.clearVelocities();
      robot.setCanSleep(true);
    }
  };
  RobotStateScene run(RobotStateKind::kTethers), other(RobotStateKind::kTethers);
  rest(run);
  run.step(150);
  ASSERT_TRUE(run.robot(0).isAwake());
  const WorldState state = run.save();
  EXPECT_GT(state.multi_bodies[0].sleep_timer, bt(1));
  const auto motions = run.record(2 * kAfter);
  ASSERT_FALSE(run.robot(0).isAwake());
  other.restore(state);
  expectSameMotion(motions, other.record(2 * kAfter));
  EXPECT_FALSE(other.robot(0).isAwake());

  const WorldState asleep = run.save();
  RobotStateScene third(RobotStateKind::kTethers);
  third.restore(asleep);
  EXPECT_FALSE(third.robot(0).isAwake());
  EXPECT_EQ(third.robot(0).getBaseCollider()->getActivationState(), ISLAND_SLEEPING);
  expectSameMotion(run.record(kAfter), third.record(kAfter));
}

// In a world that moves the boxes of what is awake alone, as PyBullet's.
TEST(RobotState, BoxesOfSleepersComeBackToo) {
  RobotStateScene run(RobotStateKind::kTethers);
  run.world().setForceUpdateAllAabbs(false);
  run.step(10);
  btMultiBody& robot = run.robot(0);
  robot.setCanSleep(true);
  robot.goToSleep();
  btMultiBodyLinkCollider& collider = *robot.getBaseCollider();
  collider.setActivationState(ISLAND_SLEEPING);
  run.world().updateSingleAabb(&collider);
  const btVector3 place = collider.getWorldTransform().getOrigin();
  const WorldState state = run.save();
  robot.setBasePos(place + btVector3(50, 0, 0));
  RobotWorld::moveColliders(robot);
  run.world().updateSingleAabb(&collider);
  ASSERT_GT(collider.getBroadphaseHandle()->m_aabbMin.x(), place.x() + 40);
  run.restore(state);
  EXPECT_EQ(collider.getActivationState(), ISLAND_SLEEPING);
  EXPECT_LT(collider.getBroadphaseHandle()->m_aabbMin.x(), place.x());
  EXPECT_GT(collider.getBroadphaseHandle()->m_aabbMax.x(), place.x());
}

TEST(RobotState, TheInertiaAtTheSurfaceIsThatBeforeSaving) {
  RobotStateScene run(RobotStateKind::kWater), other(RobotStateKind::kWater);
  run.step(40);
  other.restore(run.save());
  for (int link = -1; link < 3; ++link) {
    const Matrix6 expected = run.fluid().find(run.robot(1), link)->inertia();
    const Matrix6 found = other.fluid().find(other.robot(1), link)->inertia();
    // Of the start of the last step; its plane is found again from the pose of now.
    EXPECT_LT((found - expected).norm(), byPrecision(1e-12, 1e-4) * expected.norm());
  }
}

TEST(RobotState, IsRefusedByAWorldOfOtherRobots) {
  RobotStateScene run(RobotStateKind::kMotors);
  run.step(5);
  const WorldState state = run.save();
  const std::string motion = run.motion();
  const auto expectSays = [&](const std::function<void(WorldState&)>& change, const char* words) {
    WorldState wrong = state;
    change(wrong);
    EXPECT_NE(refusal(run, wrong).find(words), std::string::npos) << refusal(run, wrong);
  };
  using State = WorldState&;
  expectSays([](State s) { s.multi_bodies.pop_back(); }, "1 multibodies, but the world has 2");
  expectSays([](State s) { s.multi_body_joints.pop_back(); }, "5 joints of multibodies");
  expectSays([](State s) { s.multi_bodies[1].links.pop_back(); },
             "multibody 1 has 2 links, but the world's has 3");
  expectSays([](State s) { s.multi_bodies[1].velocity.pop_back(); },
             "multibody 1 has 8 velocities, but the world's has 9");
  expectSays([](State s) { s.multi_bodies[0].links[1].collider.reset(); }, "collider of link 0");
  expectSays([](State s) { s.multi_body_joints[0].applied_impulses.push_back(0); },
             "multibody joint 0 has 2 rows, but the world's has 1");
  expectSays([](State s) { s.multi_bodies[0].fluids[1].link = 7; }, "link 7");
  expectSays([](State s) { s.multi_bodies[0].fluids[1].link = -1; }, "two fluids of link -1");
  expectSays([](State s) { s.multi_bodies[0].fluids[1].ambient.def.fluid_body = nullptr; },
             "no fluid body");
  expectSays([](State s) { s.multi_bodies[0].fluids[1].ambient.def.flight.tolerance = 0; },
             "flight tolerance");
  EXPECT_TRUE(run.motion() == motion);
  RobotStateScene spheres(RobotStateKind::kFlight);
  WorldState turned = spheres.save();
  turned.multi_bodies[0].links[3].joint_position = {};
  EXPECT_NE(refusal(spheres, turned).find("not of unit length"), std::string::npos);
}

// Any of these numbers would spread through the world in the next step.
TEST(RobotState, WithNumbersThatNoWorldCanHaveIsRefused) {
  RobotStateScene run(RobotStateKind::kMotors);
  run.step(5);
  struct Forgery {
    std::function<void(MultiBodyState&)> forge;
    const char* words;
  };
  using Body = MultiBodyState&;
  const Forgery forgeries[] = {
      {[](Body b) { b.position.setX(kNaN); }, "number 1, whose pose or velocity"},
      {[](Body b) { b.interpolation_position.setZ(kInfinity); }, "pose or velocity"},
      {[](Body b) {
         b.orientation = {0, 0, 0, 0};
       },
       "unit length"},
      {[](Body b) {
         b.interpolation_orientation = {0, 0, 0, kNaN};
       },
       "unit length"},
      {[](Body b) { b.velocity[7] = kInfinity; }, "pose or velocity"},
      {[](Body b) { b.linear_damping = -1; }, "damping"},
      {[](Body b) { b.angular_damping = kNaN; }, "damping"},
      {[](Body b) { b.velocity_limit = kNaN; }, "limit of velocity"},
      {[](Body b) { b.sleep_timer = kNaN; }, "sleep"},
      {[](Body b) { b.turn_reserve = -1; }, "reserve"},
      {[](Body b) { b.links.clear(); }, "base is missing"},
      {[](Body b) { b.links[1].mass = -1; }, "link 0: mass"},
      {[](Body b) { b.links[0].inertia.setY(kNaN); }, "link -1: inertia"},
      {[](Body b) { b.links[2].joint_position[0] = kNaN; }, "link 1: pose or position"},
      {[](Body b) { b.links[2].pose.getOrigin().setX(kNaN); }, "link 1: pose or position"},
      {[](Body b) {
         b.links[2].turn_in_parent = {0, 0, 0, 2};
       },
       "link 1: turn of its joint"},
      {[](Body b) { b.links[2].way_from_parent.setX(kNaN); }, "link 1: pose or position"},
      {[](Body b) { b.links[2].joint_force[0] = kNaN; }, "link 1: force"},
      {[](Body b) { b.links[2].force.setX(kInfinity); }, "link 1: force"},
      {[](Body b) { b.links[2].collider->activation_state = 77; }, "activation state"},
      {[](Body b) { b.links[2].collider->pose.getOrigin().setX(kNaN); }, "link 1: pose"}};
  const std::string motion = run.motion();
  for (const Forgery& forgery : forgeries) {
    WorldState wrong = run.save();
    forgery.forge(wrong.multi_bodies[1]);
    const std::string said =
        refusalOf([&] { decodeState(encodeState(wrong), "forged", run.lookup()); });
    EXPECT_NE(said.find(forgery.words), std::string::npos) << forgery.words << ": " << said;
    EXPECT_NE(refusal(run, wrong), "") << forgery.words;
  }
  WorldState wrong = run.save();
  wrong.multi_body_joints[0].applied_impulses[0] = kNaN;
  EXPECT_NE(refusal(run, wrong).find("impulse"), std::string::npos);
  EXPECT_TRUE(run.motion() == motion);
}

}  // namespace
}  // namespace ambient::test
