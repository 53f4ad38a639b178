#include <BulletDynamics/ConstraintSolver/btNNCGConstraintSolver.h>
#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolverMt.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorldMt.h>
#include <BulletDynamics/Dynamics/btSimpleDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/MLCPSolvers/btDantzigSolver.h>
#include <BulletDynamics/MLCPSolvers/btMLCPSolver.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftMultiBodyDynamicsWorld.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "bullet_ambient/ambient.h"
#include "tests/support/ellipsoid_body.h"

namespace ambient::test {
namespace {

constexpr btScalar kTimeStep = btScalar(1) / 60;

AttachDef inWater() {
  return {std::make_shared<FluidBody>(meshedEllipsoid(Vector3::Ones(), 1)), water()};
}

// What a world needs besides its solver, and a body lighter than water.
class FluidFacade : public testing::Test {
 protected:
  template <class World, class Base>
  void expectRiseIn(World& world, Fluid<Base>& fluid) {
    std::string said;
    fluid.registry().setReport([&](const std::string& sentence) { said = sentence; });
    fluid.attachTo(world);
    world.setGravity({0, 0, -10});
    body.setLinearVelocity({0, 0, 0});
    world.addRigidBody(&body);
    fluid.add(body, inWater());
    for (int i = 0; i < 10; ++i) world.stepSimulation(kTimeStep, 0, kTimeStep);
    EXPECT_GT(body.getLinearVelocity().z(), 0);
    EXPECT_GE(fluid.registry().counters(body).substeps, 10);
    EXPECT_EQ(said, "");
    world.removeRigidBody(&body);
  }
  template <class World, class Base = btSequentialImpulseConstraintSolver, class... Args>
  void expectRise(Args... args) {
    Fluid<Base> fluid(args...);
    World world(&dispatcher, &broadphase, &fluid.solver(), &configuration);
    expectRiseIn(world, fluid);
  }
  template <class World, class Base>
  static std::string refusal(World& world, Fluid<Base>& fluid) {
    try {
      fluid.attachTo(world);
    } catch (const std::invalid_argument& error) {
      EXPECT_EQ(std::string(error.what()).rfind("attachTo: ", 0), 0u) << error.what();
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
      return error.what();
    }
    return {};
  }
  static void expectNames(const std::string& sentence, const char* text) {
    EXPECT_NE(sentence.find(text), std::string::npos) << sentence;
  }

  btSoftBodyRigidBodyCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btSphereShape shape{1};
  btRigidBody body{2500, nullptr, &shape, btVector3(1000, 1000, 1000)};
};

TEST_F(FluidFacade, WorksWithEveryWorldAndSolver) {
  btDantzigSolver dantzig;
  expectRise<btDiscreteDynamicsWorld>();
  expectRise<btDiscreteDynamicsWorld, btNNCGConstraintSolver>();
  expectRise<btDiscreteDynamicsWorld, btMLCPSolver>(&dantzig);
  expectRise<btDiscreteDynamicsWorld, btSequentialImpulseConstraintSolverMt>();
  expectRise<btSoftRigidDynamicsWorld>();
  expectRise<btMultiBodyDynamicsWorld, btMultiBodyConstraintSolver>();
  expectRise<btSoftMultiBodyDynamicsWorld, btMultiBodyConstraintSolver>();
}

TEST_F(FluidFacade, TakesAWorldThatHadAnotherSolver) {
  btSequentialImpulseConstraintSolver stock;
  btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &stock, &configuration);
  Fluid<> fluid;
  expectRiseIn(world, fluid);
  EXPECT_EQ(world.getConstraintSolver(), &fluid.solver());
}

// Bullet's setConstraintSolver() leaves the solver of multibodies as it is.
TEST_F(FluidFacade, TakesAMultiBodyWorldThatHadAnotherSolver) {
  auto stock = std::make_unique<btMultiBodyConstraintSolver>();
  btMultiBodyDynamicsWorld world(&dispatcher, &broadphase, stock.get(), &configuration);
  Fluid<btMultiBodyConstraintSolver> fluid;
  fluid.attachTo(world);
  stock.reset();
  expectRiseIn(world, fluid);
}

// It solves its bodies by a solver of its own that only setMultiBodyConstraintSolver() replaces,
// and calls the one that setConstraintSolver() gives for nothing that would know the world.
TEST_F(FluidFacade, IsToldHowAMultiBodyWorldTakesASolver) {
  btMultiBodyConstraintSolver stock;
  btMultiBodyDynamicsWorld world(&dispatcher, &broadphase, &stock, &configuration);
  Fluid<btMultiBodyConstraintSolver> fluid;
  std::vector<std::string> said;
  fluid.registry().setReport([&](const std::string& sentence) { said.push_back(sentence); });
  world.addAction(&fluid.action());
  world.setConstraintSolver(&fluid.solver());
  world.addRigidBody(&body);
  fluid.add(body, inWater());
  for (int i = 0; i < 5; ++i) world.stepSimulation(kTimeStep, 0, kTimeStep);
  EXPECT_EQ(fluid.registry().counters(body).substeps, 0);
  ASSERT_EQ(said.size(), 1u);
  expectNames(said[0], "call world->setMultiBodyConstraintSolver(&solver)");
  world.setMultiBodyConstraintSolver(&fluid.solver());
  for (int i = 0; i < 5; ++i) world.stepSimulation(kTimeStep, 0, kTimeStep);
  EXPECT_GE(fluid.registry().counters(body).substeps, 5);
  EXPECT_EQ(said.size(), 1u);
  world.removeRigidBody(&body);
}

TEST_F(FluidFacade, LeavesTheSolversOfAPool) {
  Fluid<btSequentialImpulseConstraintSolverMt> fluid;
  btConstraintSolver* solvers[] = {new AmbientSolver<>(fluid.registry()),
                                   new AmbientSolver<>(fluid.registry())};
  btConstraintSolverPoolMt pool(solvers, 2);
  btDiscreteDynamicsWorldMt world(&dispatcher, &broadphase, &pool, &fluid.solver(), &configuration);
  expectRiseIn(world, fluid);
  EXPECT_EQ(world.getConstraintSolver(), &pool);
}

TEST_F(FluidFacade, AttachingTwiceToOneWorldDoesNothingTwice) {
  Fluid<> fluid;
  btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &fluid.solver(), &configuration);
  fluid.attachTo(world);
  expectRiseIn(world, fluid);
}

TEST_F(FluidFacade, RefusesASecondWorld) {
  Fluid<> fluid;
  btDiscreteDynamicsWorld first(&dispatcher, &broadphase, &fluid.solver(), &configuration);
  btDiscreteDynamicsWorld second(&dispatcher, &broadphase, nullptr, &configuration);
  fluid.attachTo(first);
  expectNames(refusal(second, fluid), "another world");
  EXPECT_NE(second.getConstraintSolver(), &fluid.solver());
}

TEST_F(FluidFacade, RefusesWorldsThatCannotCarryAFluid) {
  Fluid<> fluid;
  btSimpleDynamicsWorld world(&dispatcher, &broadphase, &fluid.solver(), &configuration);
  expectNames(refusal(world, fluid), "use btDiscreteDynamicsWorld");
}

TEST_F(FluidFacade, RefusesAWorldOfMultiBodiesWithoutTheirSolver) {
  Fluid<> fluid;
  btMultiBodyConstraintSolver stock;
  btMultiBodyDynamicsWorld world(&dispatcher, &broadphase, &stock, &configuration);
  expectNames(refusal(world, fluid), "use Fluid<btMultiBodyConstraintSolver>");
}

TEST_F(FluidFacade, RefusesASolverOfMultiBodiesWithoutTheirWorld) {
  Fluid<btMultiBodyConstraintSolver> fluid;
  btDiscreteDynamicsWorld world(&dispatcher, &broadphase, nullptr, &configuration);
  expectNames(refusal(world, fluid), "use Fluid<>");
}

TEST_F(FluidFacade, ClearTakesAllBodiesOutAndTheWorldGoesOn) {
  Fluid<> fluid;
  btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &fluid.solver(), &configuration);
  fluid.attachTo(world);
  world.setGravity({0, 0, -8});
  world.addRigidBody(&body);
  fluid.add(body, inWater());
  fluid.clear();
  EXPECT_EQ(fluid.registry().size(), 0u);
  world.stepSimulation(kTimeStep, 0, kTimeStep);
  EXPECT_EQ(body.getLinearVelocity().z(), kTimeStep * -8);
  fluid.add(body, inWater());
  world.stepSimulation(kTimeStep, 0, kTimeStep);
  EXPECT_GE(fluid.registry().counters(body).substeps, 1);
  world.removeRigidBody(&body);
}

TEST_F(FluidFacade, RemovesOneBody) {
  Fluid<> fluid;
  fluid.add(body, inWater());
  EXPECT_TRUE(fluid.remove(body));
  EXPECT_FALSE(fluid.remove(body));
  EXPECT_FALSE(fluid.registry().isAttached(body));
}

TEST_F(FluidFacade, IsOfTheNextWorldAfterTheFirstWasDestroyed) {
  Fluid<> fluid;
  auto first = std::make_unique<btDiscreteDynamicsWorld>(&dispatcher, &broadphase, &fluid.solver(),
                                                         &configuration);
  fluid.attachTo(*first);
  first.reset();
  fluid.clear();
  btDiscreteDynamicsWorld second(&dispatcher, &broadphase, nullptr, &configuration);
  expectRiseIn(second, fluid);
}

// Under the address sanitizer these show that nothing looks at what is gone.
struct Destruction {
  const char* name;
  int order[3];  // 0 the fluid, 1 the world, 2 the body
};

class FluidDestruction : public testing::TestWithParam<Destruction> {};

TEST_P(FluidDestruction, LooksAtNothingThatIsGone) {
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broadphase;
  btSphereShape shape(1);
  auto fluid = std::make_unique<Fluid<>>();
  auto world = std::make_unique<btDiscreteDynamicsWorld>(&dispatcher, &broadphase, &fluid->solver(),
                                                         &configuration);
  auto body = std::make_unique<btRigidBody>(2500, nullptr, &shape, btVector3(1000, 1000, 1000));
  fluid->attachTo(*world);
  world->addRigidBody(body.get());
  fluid->add(*body, inWater());
  world->stepSimulation(kTimeStep, 0, kTimeStep);
  for (const int what : GetParam().order) {
    if (what == 0) fluid.reset();
    if (what == 1) world.reset();
    if (what == 2 && world) world->removeRigidBody(body.get());
    if (what == 2) body.reset();
    if (fluid && world) world->stepSimulation(kTimeStep, 0, kTimeStep);
  }
}

constexpr Destruction kDestructions[] = {
    {"FluidWorldBody", {0, 1, 2}}, {"FluidBodyWorld", {0, 2, 1}}, {"WorldFluidBody", {1, 0, 2}},
    {"WorldBodyFluid", {1, 2, 0}}, {"BodyFluidWorld", {2, 0, 1}}, {"BodyWorldFluid", {2, 1, 0}}};

INSTANTIATE_TEST_SUITE_P(InAnyOrder, FluidDestruction, testing::ValuesIn(kDestructions),
                         [](const auto& test) { return std::string(test.param.name); });

// The world lives on: what the header of Fluid asks for.
TEST_F(FluidFacade, AWorldOutlivesItsFluidWithAnotherSolver) {
  auto fluid = std::make_unique<Fluid<>>();
  btSequentialImpulseConstraintSolver next;
  btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &fluid->solver(), &configuration);
  fluid->attachTo(world);
  world.setGravity({0, 0, -8});
  world.addRigidBody(&body);
  fluid->add(body, inWater());
  world.removeAction(&fluid->action());
  world.setConstraintSolver(&next);
  fluid.reset();
  world.stepSimulation(kTimeStep, 0, kTimeStep);
  EXPECT_EQ(body.getLinearVelocity().z(), kTimeStep * -8);
  world.removeRigidBody(&body);
}

}  // namespace
}  // namespace ambient::test
