#include <BulletDynamics/Featherstone/btMultiBodyJointMotor.h>

#include <new>

#include "tests/bullet_ambient/bullet/robots/robot_world.h"

// Calls of a program for robots in a fluid, apart from motion.
namespace ambient::test {
namespace {

TEST_F(Robots, RefuseWhatCannotBeInAFluid) {
  btMultiBody& body = add();
  RobotDef fixed;
  fixed.has_fixed_base = true;
  EXPECT_NE(refusal(body, 3, fluidOf(body, 0)).find("links 0 to 2"), std::string::npos);
  EXPECT_NE(refusal(body, 0, {}).find("fluid body is null"), std::string::npos);
  EXPECT_NE(refusal(add(fixed), -1, fluidOf(body, 0)).find("static"), std::string::npos);
  EXPECT_EQ(refusal(body, 0, fluidOf(body, 0)), "");
  EXPECT_NE(refusal(body, 0, fluidOf(body, 0)).find("added already"), std::string::npos);
  body.useRK4Integration(true);
  EXPECT_NE(refusal(body, 1, fluidOf(body, 1)).find("RK4"), std::string::npos);
  btMultiBody& dummy = add();
  dummy.getLink(1).m_mass = 0;
  EXPECT_NE(refusal(dummy, 1, fluidOf(body, 1)).find("mass of 0"), std::string::npos);
  btDiscreteDynamicsWorld rigid(&world.dispatcher, &world.broadphase, nullptr,
                                &world.configuration);
  Fluid without(rigid);
  EXPECT_THROW(without.add(body, 1, fluidOf(body, 1)), std::invalid_argument);
}

// Contacts, motors and friction in worlds with the solver of Bullet, and with ours.
enum class Kind { kStock, kFluid, kFluidOfNoDensity };
std::vector<btScalar> moveInAir(Kind kind) {
  Arbitrary arbitrary(7);
  RobotWorld world;
  btMultiBodyConstraintSolver stock;
  if (kind == Kind::kStock) world.world.setMultiBodyConstraintSolver(&stock);
  world.world.setGravity({0, 0, bt(-9.81)});
  world.world.getSolverInfo().m_numIterations = 10;
  RobotDef def;
  def.collider_radius = 0.06;
  std::vector<btMultiBody*> robots;
  for (int i = 0; i < 3; ++i) robots.push_back(&world.add(arbitrary, def));
  world.take(std::make_unique<btMultiBodyJointMotor>(robots[0], 1, bt(1), bt(0.1)));
  world
      .addFixed(std::make_unique<btStaticPlaneShape>(btVector3(0, 0, 1), bt(-1)),
                btTransform::getIdentity())
      .setFriction(1);
  if (kind == Kind::kFluidOfNoDensity) {
    for (int link = -1; link < 3; ++link) {
      AttachDef nothing = coupledFluid(arbitrary, *robots[1], link, 2);
      nothing.medium = {};
      world.fluid.add(*robots[1], link, nothing);
    }
  }
  world.step(1 / 120.0, 240);
  std::vector<btScalar> numbers;
  for (const btMultiBody* robot : robots)
    numbers.insert(numbers.end(), robot->getVelocityVector(), robot->getVelocityVector() + 9);
  return numbers;
}

TEST_F(Robots, WithoutFluidMoveAsInBulletBitForBit) {
  const auto stock = moveInAir(Kind::kStock);
  EXPECT_EQ(moveInAir(Kind::kFluid), stock);
  EXPECT_EQ(moveInAir(Kind::kFluidOfNoDensity), stock);
}

TEST_F(Robots, MoveWithoutBulletsRungeKuttaMethod) {
  RobotDef def;
  def.speed = 0;
  btMultiBody& body = add(def);
  for (int link = -1; link < 3; ++link)
    world.fluid.add(body, link, coupledFluid(arbitrary, body, link, 100));
  body.useRK4Integration(true);
  world.world.setGravity({0, 0, -1000});
  const btScalar start = body.getBasePos().z();
  world.step(1e-2, 2);
  ASSERT_EQ(heard.size(), 1u);
  EXPECT_NE(heard[0].find("useRK4Integration"), std::string::npos);
  EXPECT_LT(start - body.getBasePos().z(), bt(0.1));  // without fluid: 0.2 m
}

TEST_F(Robots, TellThatTheirSolverIsNotAsked) {
  btMultiBody& body = add();
  world.fluid.add(body, 1, fluidOf(body, 1));
  btMultiBodyConstraintSolver stock;
  world.world.setMultiBodyConstraintSolver(&stock);
  world.step(1e-3, 3);
  ASSERT_EQ(heard.size(), 1u);
  EXPECT_NE(heard[0].find("setMultiBodyConstraintSolver"), std::string::npos);
}

// Bullet's islands keep the solver of the world's constructor.
TEST_F(Robots, TellThatSetConstraintSolverDoesNotReachThem) {
  btMultiBody& body = add();
  world.fluid.add(body, 1, fluidOf(body, 1));
  btMultiBodyConstraintSolver stock;
  world.world.setMultiBodyConstraintSolver(&stock);
  const auto solver = makeSolver<btMultiBodyConstraintSolver>(world.fluid);
  world.world.btDiscreteDynamicsWorld::setConstraintSolver(solver.get());
  world.step(1e-3, 2);
  ASSERT_FALSE(heard.empty());
  EXPECT_NE(heard[0].find("setMultiBodyConstraintSolver"), std::string::npos);
}

TEST_F(Robots, MayLeaveTheWorldAndBeDestroyed) {
  btMultiBody& body = add();
  Immersed link = world.fluid.add(body, 1, fluidOf(body, 1));
  world.step(1e-3);
  world.remove(body);
  world.step(1e-3, 3);
  EXPECT_TRUE(heard.empty());
  EXPECT_TRUE(link.remove());  // by its address alone
  EXPECT_FALSE(link.remove());
}

// Constructs another robot at the address of a destroyed one.
TEST_F(Robots, AreNotTakenForOthersAtTheirAddress) {
  alignas(btMultiBody) unsigned char place[sizeof(btMultiBody)];
  const auto make = [&place](int links) {
    auto* body = new (place) btMultiBody(links, 1, btVector3(1, 1, 1), false, false);
    for (int i = 0; i < links; ++i)
      body->setupRevolute(i, 1, btVector3(1, 1, 1), i - 1, btQuaternion::getIdentity(),
                          btVector3(0, 0, 1), btVector3(1, 0, 0), btVector3(1, 0, 0));
    body->finalizeMultiDof();
    return body;
  };
  btMultiBody* first = make(2);
  world.world.addMultiBody(first);
  world.fluid.add(*first, 1, fluidOf(*first, 1));
  world.step(1e-3);
  world.world.removeMultiBody(first);
  first->~btMultiBody();
  btMultiBody* second = make(3);
  world.world.addMultiBody(second);
  world.step(1e-3);
  EXPECT_FALSE(world.fluid.find(*second, 1));
  ASSERT_EQ(heard.size(), 1u);
  EXPECT_NE(heard[0].find("other links"), std::string::npos);
  world.world.removeMultiBody(second);
  second->~btMultiBody();
}

// Makes a robot with the same links at the address of a destroyed one.
TEST_F(Robots, OfTheSameLinksAreNotTakenForDestroyedOnes) {
  alignas(btMultiBody) unsigned char place[sizeof(btMultiBody)];
  const auto make = [&place] {
    auto* body = new (place) btMultiBody(1, 1, btVector3(1, 1, 1), false, false);
    body->setupRevolute(0, 1, btVector3(1, 1, 1), -1, btQuaternion::getIdentity(),
                        btVector3(0, 0, 1), btVector3(1, 0, 0), btVector3(1, 0, 0));
    body->finalizeMultiDof();
    return body;
  };
  btMultiBody* first = make();
  world.world.addMultiBody(first);
  const Immersed old = world.fluid.add(*first, 0, fluidOf(*first, 0));
  first->finalizeMultiDof();  // again, which changes nothing
  world.step(1e-3);
  EXPECT_TRUE(world.fluid.find(*first, 0));
  world.world.removeMultiBody(first);
  first->~btMultiBody();
  btMultiBody* second = make();
  world.world.addMultiBody(second);
  EXPECT_FALSE(world.fluid.find(*second, 0));
  world.step(1e-3);
  EXPECT_FALSE(old.isValid());
  EXPECT_EQ(world.fluid.size(), 0u);
  const Immersed added = world.fluid.add(*second, 0, fluidOf(*second, 0));
  world.step(1e-3);
  EXPECT_TRUE(added.isValid());
  world.world.removeMultiBody(second);
  second->~btMultiBody();
}

// A robot that left the world and came back keeps its own data.
TEST_F(Robots, MayLeaveTheWorldAndComeBack) {
  btMultiBody& body = add();
  const Immersed link = world.fluid.add(body, 1, fluidOf(body, 1));
  world.world.removeMultiBody(&body);
  world.step(1e-3);
  world.world.addMultiBody(&body);
  world.step(1e-3);
  EXPECT_TRUE(link.isValid());
  EXPECT_TRUE(heard.empty());
}

TEST_F(Robots, SleepAtRestAndNotWhileTheyDrift) {
  RobotDef def;
  def.speed = 0;
  def.collider_radius = 0.02;
  btMultiBody& resting = add(def);
  btMultiBody& drifting = add(def);
  for (btMultiBody* body : {&resting, &drifting}) {
    body->setCanSleep(true);
    putIntoFluid(arbitrary, world, *body, 2);
  }
  drifting.setBaseVel({bt(0.02), 0, 0});  // Bullet's threshold is sqrt(0.05) m/s
  world.step(1 / 60.0, 200);
  EXPECT_FALSE(resting.isAwake());
  EXPECT_TRUE(drifting.isAwake());
  world.fluid.find(resting, 0)->setMedium(idealFluid(2));
  EXPECT_TRUE(resting.isAwake());
}

}  // namespace
}  // namespace ambient::test
