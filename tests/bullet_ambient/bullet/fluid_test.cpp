#include <BulletDynamics/ConstraintSolver/btNNCGConstraintSolver.h>
#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolverMt.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorldMt.h>
#include <BulletDynamics/Dynamics/btSimpleDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/MLCPSolvers/btDantzigSolver.h>
#include <BulletDynamics/MLCPSolvers/btMLCPSolver.h>
#include <BulletSoftBody/btDeformableBodySolver.h>
#include <BulletSoftBody/btDeformableMultiBodyConstraintSolver.h>
#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <BulletSoftBody/btSoftMultiBodyDynamicsWorld.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <type_traits>

#include "bullet_ambient/ambient.h"
#include "tests/bullet_ambient/bullet/rising_ball.h"
#include "tests/support/refusal_of.h"

namespace ambient::test {
namespace {

constexpr btScalar kDoorStep = btScalar(1) / 60;

// A world, what others need besides their solver, and a body lighter than water.
class FluidDoor : public testing::Test, protected WorldParts<>, protected RisingBall {
 protected:
  // Without bodies in the fluid, Bullet's gravity alone.
  void expectStockFallIn(btDynamicsWorld& world) {
    world.setGravity({0, 0, -8});
    body.setLinearVelocity({0, 0, 0});
    world.addRigidBody(&body);
    world.stepSimulation(kDoorStep, 0, kDoorStep);
    EXPECT_EQ(body.getLinearVelocity().z(), kDoorStep * -8);
    world.removeRigidBody(&body);
  }
  template <class World>
  void expectRise() {
    constexpr bool kHasMultiBodies = std::is_base_of_v<btMultiBodyDynamicsWorld, World>;
    std::conditional_t<kHasMultiBodies, btMultiBodyConstraintSolver,
                       btSequentialImpulseConstraintSolver>
        solver;
    World any(&dispatcher, &broadphase, &solver, &configuration);
    {
      Fluid fluid(any);
      EXPECT_NE(any.getConstraintSolver(), &solver);
      expectRiseIn(any, fluid);
    }
    EXPECT_EQ(any.getConstraintSolver(), &solver);
    expectStockFallIn(any);
  }
  template <class Base, class... Args>
  void expectRiseWith(Args... args) {
    discrete.setConstraintSolver(&sequential);
    Fluid fluid(discrete);
    const auto solver = makeSolver<Base>(fluid, args...);
    discrete.setConstraintSolver(solver.get());
    expectRiseIn(discrete, fluid);
  }
  static std::string refusal(btDynamicsWorld& world) {
    const btConstraintSolver* solver = world.getConstraintSolver();
    const std::string said = refusalOf<std::invalid_argument>([&] { const Fluid fluid(world); });
    EXPECT_EQ(said.rfind("Fluid: ", 0), 0u) << said;
    EXPECT_EQ(said.find('\n'), std::string::npos);
    EXPECT_EQ(world.getConstraintSolver(), solver);
    return said;
  }
  static void expectNames(const std::string& sentence, const char* text) {
    EXPECT_NE(sentence.find(text), std::string::npos) << sentence;
  }

  btSequentialImpulseConstraintSolver sequential;
  btDiscreteDynamicsWorld discrete{&dispatcher, &broadphase, &sequential, &configuration};
};

TEST_F(FluidDoor, FitsEveryWorldAndGivesItsSolverBack) {
  expectRise<btDiscreteDynamicsWorld>();
  expectRise<btSoftRigidDynamicsWorld>();
  expectRise<btMultiBodyDynamicsWorld>();
  expectRise<btSoftMultiBodyDynamicsWorld>();
}

TEST_F(FluidDoor, MakesSolversOfTheUsersChoice) {
  btDantzigSolver dantzig;
  expectRiseWith<btNNCGConstraintSolver>();
  expectRiseWith<btMLCPSolver>(&dantzig);
  expectRiseWith<btSequentialImpulseConstraintSolverMt>();
}

// Bullet would free the memory of a solver that the world has made itself.
TEST_F(FluidDoor, GivesAWorldTheSolverBackThatItHasMadeItself) {
  btDiscreteDynamicsWorld world(&dispatcher, &broadphase, nullptr, &configuration);
  const btConstraintSolver* own = world.getConstraintSolver();
  {
    Fluid fluid(world);
    expectRiseIn(world, fluid);
  }
  EXPECT_EQ(world.getConstraintSolver(), own);
  expectStockFallIn(world);
}

TEST_F(FluidDoor, WorksInAPoolOfSolversThatItHasMade) {
  btConstraintSolverPoolMt plain(2);
  btDiscreteDynamicsWorldMt world(&dispatcher, &broadphase, &plain, nullptr, &configuration);
  world.setConstraintSolver(&sequential);
  Fluid fluid(world);
  btConstraintSolver* solvers[] = {makeSolver<btNNCGConstraintSolver>(fluid).release(),
                                   makeSolver<btNNCGConstraintSolver>(fluid).release()};
  btConstraintSolverPoolMt pool(solvers, 2);
  world.setConstraintSolver(&pool);
  expectRiseIn(world, fluid);
}

TEST_F(FluidDoor, GoesOnWithTheRandomNumbersOfTheSolver) {
  sequential.setRandSeed(1234);
  const Fluid fluid(discrete);
  const auto* made =
      dynamic_cast<btSequentialImpulseConstraintSolver*>(discrete.getConstraintSolver());
  ASSERT_NE(made, nullptr);
  EXPECT_EQ(made->getRandSeed(), 1234u);
}

TEST_F(FluidDoor, RefusesWorldsThatCannotCarryAFluid) {
  btSimpleDynamicsWorld simple(&dispatcher, &broadphase, &sequential, &configuration);
  expectNames(refusal(simple), "btSimpleDynamicsWorld");
  expectNames(refusal(simple), "use btDiscreteDynamicsWorld");
  btDeformableMultiBodyConstraintSolver solver;
  btDeformableBodySolver bodies;
  solver.setDeformableSolver(&bodies);
  btDeformableMultiBodyDynamicsWorld deformable(&dispatcher, &broadphase, &solver, &configuration,
                                                &bodies);
  expectNames(refusal(deformable), "btDeformableMultiBodyDynamicsWorld");
  expectNames(refusal(deformable), "btSoftRigidDynamicsWorld");
  btConstraintSolverPoolMt pool(1);
  btSequentialImpulseConstraintSolverMt for_large_islands;
  btDiscreteDynamicsWorldMt threaded(&dispatcher, &broadphase, &pool, &for_large_islands,
                                     &configuration);
  threaded.setConstraintSolver(&sequential);
  expectNames(refusal(threaded), "large islands");
}

TEST_F(FluidDoor, RefusesSolversThatAreNotPlainAndNamesMakeSolver) {
  btNNCGConstraintSolver gradients;
  discrete.setConstraintSolver(&gradients);
  expectNames(refusal(discrete), "makeSolver<Base>(fluid)");
  btMultiBodyConstraintSolver of_multi_bodies;
  discrete.setConstraintSolver(&of_multi_bodies);
  expectNames(refusal(discrete), "plain btSequentialImpulseConstraintSolver;");
  btConstraintSolverPoolMt pool(1);
  btDiscreteDynamicsWorldMt pooled(&dispatcher, &broadphase, &pool, nullptr, &configuration);
  expectNames(refusal(pooled), "makeSolver<Base>(fluid)");
}

TEST_F(FluidDoor, RefusesAWorldThatHasAFluid) {
  Fluid fluid(discrete);
  EXPECT_NE(refusal(discrete), "");
  expectRiseIn(discrete, fluid);
}

TEST_F(FluidDoor, ClearTakesAllBodiesOutAndTheWorldGoesOn) {
  Fluid fluid(discrete);
  fluid.add(body, unitBallIn(water()));
  fluid.clear();
  EXPECT_EQ(fluid.size(), 0u);
  EXPECT_FALSE(fluid.find(body));
  expectStockFallIn(discrete);
  expectRiseIn(discrete, fluid);
}

TEST_F(FluidDoor, LeavesAWorldTheSolverThatItWasGivenSince) {
  btSequentialImpulseConstraintSolver later;
  {
    const Fluid fluid(discrete);
    discrete.setConstraintSolver(&later);
  }
  EXPECT_EQ(discrete.getConstraintSolver(), &later);
  expectStockFallIn(discrete);
}

// A host of plugins deletes the solver of its world in place of the one that it has made.
TEST_F(FluidDoor, SurvivesASolverThatSomebodyElseDeletes) {
  btMultiBodyConstraintSolver plain, next;
  btMultiBodyDynamicsWorld world(&dispatcher, &broadphase, &plain, &configuration);
  std::string said;
  {
    Fluid fluid(world);
    fluid.setReport([&](const std::string& sentence) { said = sentence; });
    world.addRigidBody(&body);
    fluid.add(body, unitBallIn(water()));
    world.stepSimulation(kDoorStep, 0, kDoorStep);
    delete world.getConstraintSolver();
    world.setMultiBodyConstraintSolver(&next);
    for (int i = 0; i < 3; ++i) world.stepSimulation(kDoorStep, 0, kDoorStep);
    expectNames(said, "no solver of their Fluid was called");
    world.removeRigidBody(&body);
  }
  EXPECT_EQ(world.getConstraintSolver(), &next);
  expectStockFallIn(world);
}

TEST_F(FluidDoor, ASolverThatOutlivesItSolvesAsBulletDoes) {
  auto fluid = std::make_unique<Fluid>(discrete);
  const auto solver = makeSolver<btNNCGConstraintSolver>(*fluid);
  discrete.setConstraintSolver(solver.get());
  fluid->add(body, unitBallIn(water()));
  fluid.reset();
  expectStockFallIn(discrete);
}

// Orders of destruction, the fluid before its world; the address sanitizer finds access to
// destroyed objects.
struct Destruction {
  const char* name;
  const char* order;  // of f: fluid, w: world, b: body, s: solver of the fluid, p: plain solver
};

class FluidDestruction : public testing::TestWithParam<Destruction> {};

TEST_P(FluidDestruction, LooksAtNothingThatIsGone) {
  WorldParts<> parts;
  btSphereShape shape(1);
  auto plain = std::make_unique<btSequentialImpulseConstraintSolver>();
  auto world = std::make_unique<btDiscreteDynamicsWorld>(&parts.dispatcher, &parts.broadphase,
                                                         plain.get(), &parts.configuration);
  auto body = std::make_unique<btRigidBody>(2500, nullptr, &shape, btVector3(1000, 1000, 1000));
  auto fluid = std::make_unique<Fluid>(*world);
  world->addRigidBody(body.get());
  const Immersed ball = fluid->add(*body, unitBallIn(water()));
  world->stepSimulation(kDoorStep, 0, kDoorStep);
  const std::string order = GetParam().order;
  bool can_step = true;
  for (const char what : order) {
    if (what == 'f') fluid.reset();
    if (what == 'w') world.reset();
    if (what == 'b' && world) world->removeRigidBody(body.get());
    if (what == 'b') body.reset();
    if (what == 's' && world) delete world->getConstraintSolver();
    if (what == 'p') plain.reset();
    can_step = can_step && world && (fluid ? what != 's' : plain != nullptr);
    if (can_step) world->stepSimulation(kDoorStep, 0, kDoorStep);
    if (fluid) continue;
    EXPECT_FALSE(ball.isValid());
    EXPECT_THROW(ball.counters(), std::logic_error);
  }
}

constexpr Destruction kDestructions[] = {
    {"FluidWorldBody", "fwbp"},       {"FluidBodyWorld", "fbwp"},
    {"BodyFluidWorld", "bfwp"},       {"PlainFluidWorldBody", "pfwb"},
    {"SolverFluidWorldBody", "sfwb"}, {"BodySolverFluidWorld", "bsfw"}};

INSTANTIATE_TEST_SUITE_P(InOrders, FluidDestruction, testing::ValuesIn(kDestructions),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace ambient::test
