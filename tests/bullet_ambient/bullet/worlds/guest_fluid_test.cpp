// A fluid in a world that belongs to somebody else, who exchanges its solver.
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyMLCPConstraintSolver.h>
#include <BulletDynamics/MLCPSolvers/btDantzigSolver.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "bullet_ambient/ambient.h"
#include "tests/bullet_ambient/bullet/rising_ball.h"

namespace ambient::test {
namespace {

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

TEST_F(GuestFluid, KnowsWhenItsWorldHasEnded) {
  const std::unique_ptr<btConstraintSolver> own(world->getConstraintSolver());
  Fluid fluid(*world, SolverOwner::kAsksWorld);
  EXPECT_TRUE(fluid.isWorldAlive());
  world.reset();
  EXPECT_FALSE(fluid.isWorldAlive());
  EXPECT_THROW(fluid.refit(), std::logic_error);
  EXPECT_THROW(fluid.addLaterBodies(), std::logic_error);
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
