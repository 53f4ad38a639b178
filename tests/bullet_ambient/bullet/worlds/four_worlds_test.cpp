#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyMLCPConstraintSolver.h>
#include <BulletDynamics/MLCPSolvers/btDantzigSolver.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "bullet_ambient/ambient.h"
#include "bullet_ambient/bullet/core/body_motion.h"
#include "tests/bullet_ambient/bullet/fluid_world.h"
#include "tests/bullet_ambient/bullet/rising_ball.h"
#include "tests/bullet_ambient/bullet/worlds/world_setups.h"
#include "tests/support/bodies/free_body.h"
#include "tests/support/rotations.h"

namespace ambient::test {
namespace {

// Ambient bodies in flight, on a tether and on the floor, in every world and with every
// solver.

const Vector3 kSemiAxes{0.3, 0.25, 0.2};
const Vector3 kCentreOfVolume{0.01, -0.02, 0.03};  // off the centre of mass: coupled K
const Twist kSpin{Vector3(0.3, 0.2, 1), Vector3::Zero()};
// Boxes around an ellipsoid of water.
class Tank {
 public:
  explicit Tank(std::unique_ptr<WorldHost> host, int number = 0) : host_(std::move(host)) {
    host_->world().setGravity({0, 0, static_cast<btScalar>(-9.81)});
    contents_.add(0, floor_, btTransform(btQuaternion::getIdentity(), btVector3(0, 0, -1)));
    flying_ = &add(1.5, {Quaternion::Identity(), {0, 0, 50}, kSpin});
    sinking_ = &add(2, {Quaternion::Identity(), {6, 0, 0.4}, kSpin});
    addTethered();
    flying_->setLinearVelocity(bt(0.2 * number) * btVector3(1, 2, 3));
    sinking_->setLinearVelocity({bt(0.1 * number), 0, 0});
  }
  Fluid& fluid() { return host_->fluid(); }
  void step(int count, double duration = kWorldStep) { host_->step(duration, count); }
  // Without this flag only solvers with pools of their own have one friction row per contact.
  void useTwoFrictionDirections() {
    host_->world().getSolverInfo().m_solverMode |= SOLVER_USE_2_FRICTION_DIRECTIONS;
  }
  const btRigidBody& flying() const { return *flying_; }
  const btRigidBody& tethered() const { return *tethered_; }
  const btRigidBody& sinking() const { return *sinking_; }
  double tetherStretch() const {
    const btVector3 end = tethered_->getWorldTransform() * tether_->getPivotInA();
    return static_cast<double>((end - tether_->getPivotInB()).length());
  }

 private:
  // Adds a body of half water's density in equilibrium: buoyancy is twice the weight, and their sum
  // points upwards from the tether.
  void addTethered() {
    const Vector3 below(0, 0, -0.4);
    const Vector3 up = 2 * (kCentreOfVolume - below) + below;
    tethered_ = &add(0.5, startAt({3, 0, 2}, {}, rotationBetween(up, Vector3::UnitZ())));
    tethered_->setActivationState(DISABLE_DEACTIVATION);
    tether_ =
        &contents_.take(std::make_unique<btPoint2PointConstraint>(*tethered_, toBullet(below)));
  }
  // `density`: body's over water's. `start`: twist in world axes.
  btRigidBody& add(double density, const RigidState& start) {
    AttachDef def{fluid_body_, water()};
    def.fluid_frame.translation = kCentreOfVolume;
    const double mass = density * water().density * fluid_body_->volume;
    btRigidBody& body =
        contents_.add(mass, toBullet(ellipsoidMoments(kSemiAxes, mass)), box_,
                      btTransform(toBullet(start.orientation), toBullet(start.position)));
    body.setAngularVelocity(toBullet(start.twist.angular));
    host_->fluid().add(body, def);
    return body;
  }

  std::unique_ptr<WorldHost> host_;
  std::shared_ptr<const FluidBody> fluid_body_ =
      std::make_shared<FluidBody>(meshedEllipsoid(kSemiAxes, 1));
  btBoxShape floor_{btVector3(50, 50, 1)};
  btBoxShape box_{toBullet(kSemiAxes)};
  WorldContents contents_{host_->world()};
  btRigidBody *flying_ = nullptr, *tethered_ = nullptr, *sinking_ = nullptr;
  const btPoint2PointConstraint* tether_ = nullptr;
};

// Excludes Lemke's solver: it needs friction, and is wrong where bounds coincide, with fluid or
// without.
std::vector<WorldSetup> worldsWithRestingContacts() {
  std::vector<WorldSetup> worlds = allWorlds();
  const auto uses_lemke = [](const WorldSetup& setup) { return usesSolver(setup, "Lemke"); };
  worlds.erase(std::remove_if(worlds.begin(), worlds.end(), uses_lemke), worlds.end());
  return worlds;
}

class FourWorlds : public testing::TestWithParam<WorldSetup> {};
INSTANTIATE_TEST_SUITE_P(Of, FourWorlds, testing::ValuesIn(allWorlds()), nameOf);

TEST_P(FourWorlds, FlyABodyAllAlike) {
  Tank reference(worldNamed("DiscreteWithSequentialImpulse").make(true)),
      tank(GetParam().make(true));
  reference.step(240);
  tank.step(240);
  EXPECT_LT(static_cast<double>(tank.flying().getWorldTransform().getOrigin().z()), 48);
  EXPECT_TRUE(moveAlike(tank.flying(), reference.flying()));
}

TEST_P(FourWorlds, HoldABuoyantBodyOnItsTether) {
  Tank tank(GetParam().make(true));
  const Quaternion start = readState(tank.tethered()).orientation;
  tank.step(600);
  // The joint yields by its position error of one step.
  EXPECT_LT(tank.tetherStretch(), byPrecision(1e-9, 1e-5));
  EXPECT_LT(angleBetween(readState(tank.tethered()).orientation, start), byPrecision(1e-8, 1e-3));
}

TEST_P(FourWorlds, StepTogetherWithTheBitsOfEach) {
  constexpr int kTanks = 9;
  std::vector<std::unique_ptr<Tank>> together, alone;
  std::vector<Fluid*> fluids;
  for (int i = 0; i < kTanks; ++i) {
    for (auto* tanks : {&together, &alone})
      tanks->push_back(std::make_unique<Tank>(GetParam().make(true), i));
    fluids.push_back(&together.back()->fluid());
  }
  const auto heightOf = [&](int i) {
    return together[i]->flying().getWorldTransform().getOrigin();
  };
  const auto durationOf = [](int i) { return i < 6 ? kWorldStep : kWorldStep / 2; };
  for (int n = 0; n < 60; ++n) {
    const btVector3 before = heightOf(0);
    const auto step = [&](int i) {
      EXPECT_EQ(heightOf(0), before) << i;  // Bullet moves the first world last
      if (n % 7 != i) together[i]->step(1, durationOf(i));
    };
    if (usesSolver(GetParam(), "Mt")) {
      EXPECT_THROW(stepTogether(fluids.data(), kTanks, step), std::invalid_argument);
      return;
    }
    stepTogether(fluids.data(), kTanks, step);
    for (int i = 0; i < kTanks; ++i) {
      if (n % 7 != i) alone[i]->step(1, durationOf(i));
      EXPECT_TRUE(moveAlike(together[i]->flying(), alone[i]->flying())) << i;
      EXPECT_TRUE(moveAlike(together[i]->sinking(), alone[i]->sinking())) << i;
      EXPECT_TRUE(moveAlike(together[i]->tethered(), alone[i]->tethered())) << i;
    }
    ASSERT_FALSE(HasFailure()) << n;
  }
}

TEST(StepTogether, TellsEachFluidOfItsOwnBodies) {
  FluidWorld calm, torn;
  for (FluidWorld* each : {&calm, &torn})
    each->add(BodyDef{}, *unitBallIn(water()).fluid_body, idealFluid(0.1));
  torn.contents.bodies()[0]->setLinearVelocity({bt(1e38), 0, 0});
  torn.contents.bodies()[0]->setAngularVelocity({bt(1e38), bt(1e38), 0});
  FluidWorld* const worlds[] = {&calm, &torn};
  Fluid* const fluids[] = {&calm.fluid, &torn.fluid};
  stepTogether(fluids, 2, [&](int i) { worlds[i]->step(kWorldStep); });
  EXPECT_EQ(calm.said, std::vector<std::string>{});
  EXPECT_NE(torn.said, std::vector<std::string>{});
}

class RestingContacts : public FourWorlds {};
INSTANTIATE_TEST_SUITE_P(Of, RestingContacts, testing::ValuesIn(worldsWithRestingContacts()),
                         nameOf);

TEST_P(RestingContacts, LetABodySinkToTheFloorAndSleep) {
  Tank tank(GetParam().make(true));
  tank.step(600);
  EXPECT_NEAR(static_cast<double>(tank.sinking().getWorldTransform().getOrigin().z()),
              kSemiAxes.z(), 1e-3);
  EXPECT_FALSE(tank.sinking().isActive());
}

class SequentialWorlds : public FourWorlds {};
INSTANTIATE_TEST_SUITE_P(Of, SequentialWorlds,
                         testing::Values(worldNamed("DiscreteWithMultithreaded"),
                                         worldNamed("SoftWithSequentialImpulse"),
                                         worldNamed("DiscreteMtWithPool")),
                         nameOf);

// Stock Bullet has equal rows in equal order; a btMultiBodyDynamicsWorld orders them differently.
TEST_P(SequentialWorlds, MoveContactsAndJointsAlike) {
  Tank reference(worldNamed("DiscreteWithSequentialImpulse").make(true)),
      tank(GetParam().make(true));
  for (Tank* each : {&reference, &tank}) each->useTwoFrictionDirections();
  for (int i = 0; i < 10; ++i) {
    reference.step(30);
    tank.step(30);
    EXPECT_TRUE(moveAlike(tank.tethered(), reference.tethered())) << i;
    EXPECT_TRUE(moveAlike(tank.sinking(), reference.sinking())) << i;
  }
}

// A fluid in a world that belongs to somebody else, who exchanges its solver.

constexpr btScalar kTickOfOwner = btScalar(1) / 60;

class GuestFluid : public testing::Test, protected WorldParts<>, protected RisingBall {
 protected:
  GuestFluid() { world->setGravity({0, 0, -10}); }
  // Replaces the world's solver like PyBullet's setPhysicsEngineParameter(constraintSolverType=).
  btMultiBodyConstraintSolver* exchangeSolver(bool has_mlcp) {
    delete world->getConstraintSolver();
    auto* next =
        has_mlcp ? new btMultiBodyMLCPConstraintSolver(&dantzig) : new btMultiBodyConstraintSolver;
    world->setMultiBodyConstraintSolver(next);
    return next;
  }
  void expectRise(Fluid& fluid) { expectRiseIn(*world, fluid); }

  btDantzigSolver dantzig;
  std::unique_ptr<btMultiBodyDynamicsWorld> world = std::make_unique<btMultiBodyDynamicsWorld>(
      &dispatcher, &broadphase, new btMultiBodyConstraintSolver, &configuration);
};

TEST_F(GuestFluid, TakesThePlaceOfSolversThatTheOwnerGivesTheWorld) {
  Fluid fluid(*world, SolverOwner::kAsksWorld);
  for (const bool has_mlcp : {true, true, false, false}) {
    SCOPED_TRACE(has_mlcp);
    const btConstraintSolver* next = exchangeSolver(has_mlcp);
    fluid.refit();
    const btConstraintSolver* fitted = world->getConstraintSolver();
    EXPECT_NE(fitted, next);
    fluid.refit();
    EXPECT_EQ(world->getConstraintSolver(), fitted);
    expectRise(fluid);
  }
  delete world->getConstraintSolver();
}

TEST_F(GuestFluid, DeletesTheSolversThatTheOwnerHasLost) {
  // A solver that leaks or is deleted twice fails this test in the build with sanitizers.
  {
    Fluid fluid(*world, SolverOwner::kAsksWorld);
    exchangeSolver(true);
    fluid.refit();
    exchangeSolver(false);
    fluid.refit();
    exchangeSolver(false);  // without a step after it
  }
  delete world->getConstraintSolver();
}

TEST_F(GuestFluid, LeavesTheSolverToAnOwnerWhoKnowsIt) {
  btMultiBodyConstraintSolver next;
  const std::unique_ptr<btConstraintSolver> own(world->getConstraintSolver());
  Fluid fluid(*world);
  delete world->getConstraintSolver();
  world->setMultiBodyConstraintSolver(&next);
  fluid.refit();
  expectRise(fluid);
}

TEST_F(GuestFluid, RefusesToRefitASolverThatItDoesNotKnow) {
  struct OtherSolver : btMultiBodyConstraintSolver {
  } other;
  Fluid fluid(*world, SolverOwner::kAsksWorld);
  delete world->getConstraintSolver();
  world->setMultiBodyConstraintSolver(&other);
  EXPECT_THROW(fluid.refit(), std::invalid_argument);
  EXPECT_EQ(world->getConstraintSolver(), &other);
}

struct BallSource : FluidBodySource {
  std::shared_ptr<const FluidBody> fluidBody(const btCollisionShape&) override { return shape; }
  std::shared_ptr<const FluidBody> shape = unitBallIn(water()).fluid_body;
};

TEST_F(GuestFluid, AddsLaterBodiesBeforeTheirFirstSubstep) {
  const std::unique_ptr<btConstraintSolver> own(world->getConstraintSolver());
  BallSource source;
  Fluid fluid(*world);
  AttachSettings settings;
  settings.later_bodies = true;
  fluid.addAll(source, water(), settings);
  world->addRigidBody(&body);
  EXPECT_EQ(fluid.size(), 0u);
  fluid.addLaterBodies();
  EXPECT_EQ(fluid.size(), 1u);
  world->stepSimulation(kTickOfOwner, 0, kTickOfOwner);
  EXPECT_EQ(fluid.size(), 1u);
  EXPECT_GT(body.getLinearVelocity().z(), 0);
  world->removeRigidBody(&body);
}

}  // namespace
}  // namespace ambient::test
