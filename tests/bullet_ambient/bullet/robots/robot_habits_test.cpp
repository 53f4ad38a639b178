#include <BulletDynamics/Featherstone/btMultiBodyJointFeedback.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointMotor.h>
#include <BulletDynamics/Featherstone/btMultiBodyMLCPConstraintSolver.h>
#include <BulletDynamics/MLCPSolvers/btDantzigSolver.h>
#include <gtest/gtest.h>

#include <new>
#include <stdexcept>
#include <string>
#include <vector>

#include "bullet_ambient/bullet/multibody_dynamics.h"
#include "tests/bullet_ambient/bullet/robots/robot_world.h"
#include "tests/support/ellipsoid_body.h"
#include "tests/support/part_bodies.h"

// What a program may do with robots in a fluid, besides moving them.
namespace ambient::test {
namespace {

class Robots : public testing::Test {
 protected:
  Robots() {
    world.fluid.registry().setReport([this](const std::string& text) { heard.push_back(text); });
  }
  btMultiBody& add(const RobotDef& def = {}) { return world.add(arbitrary, def); }
  AttachDef fluidOf(const btMultiBody& body, int link) {
    return coupledFluid(arbitrary, body, link, 2);
  }
  std::string refusal(btMultiBody& body, int link, const AttachDef& def) {
    try {
      world.fluid.add(body, link, def);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  }

  std::vector<std::string> heard;
  Arbitrary arbitrary{5};
  RobotWorld world;
};

TEST_F(Robots, RefuseWhatCannotBeInAFluid) {
  btMultiBody& body = add();
  RobotDef fixed;
  fixed.has_fixed_base = true;
  EXPECT_NE(refusal(body, 3, fluidOf(body, 0)).find("links 0 to 2"), std::string::npos);
  EXPECT_NE(refusal(body, 0, {}).find("fluid body is null"), std::string::npos);
  EXPECT_NE(refusal(add(fixed), -1, fluidOf(body, 0)).find("static"), std::string::npos);
  EXPECT_EQ(refusal(body, 0, fluidOf(body, 0)), "");
  EXPECT_NE(refusal(body, 0, fluidOf(body, 0)).find("attached already"), std::string::npos);
  body.useRK4Integration(true);
  EXPECT_NE(refusal(body, 1, fluidOf(body, 1)).find("RK4"), std::string::npos);
  btMultiBody& dummy = add();
  dummy.getLink(1).m_mass = 0;
  EXPECT_NE(refusal(dummy, 1, fluidOf(body, 1)).find("mass of 0"), std::string::npos);
  RobotWorld other;
  EXPECT_THROW(world.fluid.registry().attach(other.world, body, 1, fluidOf(body, 1)),
               std::invalid_argument);
  Fluid<btMultiBodyConstraintSolver> untied;
  EXPECT_THROW(untied.add(body, 1, fluidOf(body, 1)), std::invalid_argument);
}

TEST_F(Robots, KnowTheirFluids) {
  btMultiBody& body = add();
  AmbientRegistry& registry = world.fluid.registry();
  const AttachDef def = fluidOf(body, 1);
  world.fluid.add(body, 1, def);
  EXPECT_TRUE(registry.isAttached(body, 1));
  EXPECT_FALSE(registry.isAttached(body, 0));
  Matrix6 expected = def.fluid_body->added_mass;
  expected.diagonal().head<3>() += toVector3(body.getLinkInertia(1));
  expected.diagonal().tail<3>().array() += static_cast<double>(body.getLinkMass(1));
  EXPECT_LT((registry.inertia(body, 1) - expected).norm(), 1e-6 * expected.norm());
  registry.setMedium(body, 1, idealFluid(3));
  EXPECT_EQ(registry.medium(body, 1).density, 3);
  EXPECT_THROW(registry.setMedium(body, 0, idealFluid(3)), std::invalid_argument);
  EXPECT_TRUE(world.fluid.remove(body, 1));
  EXPECT_FALSE(world.fluid.remove(body, 1));
  EXPECT_FALSE(world.fluid.remove(body));
}

// Contacts, motors and friction in worlds with the solver of Bullet, and with ours.
std::vector<btScalar> moveInAir(std::unique_ptr<btMultiBodyConstraintSolver> stock,
                                bool has_empty_fluid) {
  Arbitrary arbitrary(7);
  RobotWorld world(std::move(stock));
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
  if (has_empty_fluid) {
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
  const auto stock = moveInAir(std::make_unique<btMultiBodyConstraintSolver>(), false);
  EXPECT_EQ(moveInAir(nullptr, false), stock);
  EXPECT_EQ(moveInAir(nullptr, true), stock);
}

TEST_F(Robots, OfOneBodyMoveAsTheSameRigidBody) {
  RobotDef alone;
  alone.links = 0;
  btMultiBody& body = add(alone);
  const AttachDef def = fluidOf(body, -1);
  world.fluid.add(body, -1, def);
  btRigidBody rigid(btRigidBody::btRigidBodyConstructionInfo(body.getBaseMass(), nullptr, nullptr,
                                                             body.getBaseInertia()));
  btEmptyShape shape;
  rigid.setCollisionShape(&shape);
  rigid.setWorldTransform(body.getBaseWorldTransform());
  rigid.setAngularVelocity(body.getBaseOmega());
  rigid.setLinearVelocity(body.getBaseVel());
  world.world.addRigidBody(&rigid);
  world.fluid.add(rigid, def);
  world.step(1 / 2000.0, 1000);
  EXPECT_LT((body.getBasePos() - rigid.getWorldTransform().getOrigin()).length(), bt(1e-5));
  EXPECT_LT((body.getBaseOmega() - rigid.getAngularVelocity()).length(), bt(1e-4));
  world.world.removeRigidBody(&rigid);
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

// The islands keep the solver of the constructor.
TEST_F(Robots, TellThatSetConstraintSolverDoesNotReachThem) {
  Fluid<btMultiBodyConstraintSolver> fluid;
  std::vector<std::string> reports;
  fluid.registry().setReport([&reports](const std::string& text) { reports.push_back(text); });
  RobotWorld stock(std::make_unique<btMultiBodyConstraintSolver>());
  btMultiBody& body = stock.add(arbitrary, {});
  stock.world.setConstraintSolver(&fluid.solver());
  stock.world.addAction(&fluid.action());
  fluid.registry().attach(stock.world, body, 1, fluidOf(body, 1));
  stock.step(1e-3, 2);
  ASSERT_FALSE(reports.empty());
  EXPECT_NE(reports[0].find("setMultiBodyConstraintSolver"), std::string::npos);
}

TEST_F(Robots, MayLeaveTheWorldAndBeDestroyed) {
  btMultiBody& body = add();
  world.fluid.add(body, 1, fluidOf(body, 1));
  world.step(1e-3);
  world.remove(body);
  world.step(1e-3, 3);
  EXPECT_TRUE(heard.empty());
  world.fluid.remove(body);  // by its address alone
}

// Of other links, at the address of one that was destroyed.
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
  EXPECT_FALSE(world.fluid.registry().isAttached(*second, 1));
  ASSERT_EQ(heard.size(), 1u);
  EXPECT_NE(heard[0].find("other links"), std::string::npos);
  world.world.removeMultiBody(second);
  second->~btMultiBody();
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
  world.fluid.registry().setMedium(resting, 0, idealFluid(2));
  EXPECT_TRUE(resting.isAwake());
}

TEST_F(Robots, TellTheMassMatrixAndTheForcesOfAnAcceleration) {
  btMultiBody& body = add();
  putIntoFluid(arbitrary, world, body, 2);
  world.world.setGravity({0, 0, bt(-9.81)});
  const AmbientRegistry& registry = world.fluid.registry();
  const Eigen::MatrixXd H = ambientMassMatrix(registry, body);
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(9), some = Eigen::VectorXd::Random(9);
  const Eigen::VectorXd change =
      ambientInverseDynamics(registry, body, some) - ambientInverseDynamics(registry, body, none);
  EXPECT_LT(relativeError(change, H * some), 1e-12);
  const Eigen::VectorXd u = velocityOf(body);
  EXPECT_NEAR(kineticEnergy(registry, body), u.dot(H * u) / 2, 1e-12 * u.dot(H * u));
  EXPECT_THROW(ambientInverseDynamics(registry, body, Eigen::VectorXd::Zero(8)),
               std::invalid_argument);
  // What it does without any force, for a moment.
  const Eigen::VectorXd rate = H.ldlt().solve(-ambientInverseDynamics(registry, body, none));
  const double moment = byPrecision(1e-7, 1e-3);
  world.step(moment);
  const Eigen::VectorXd after = (velocityOf(body) - u) / moment;
  EXPECT_LT(relativeError(after, rate), byPrecision(1e-5, 1e-2));
}

// A link of volume V that a fixed joint holds: weight and buoyancy.
TEST_F(Robots, FeelBuoyancyInTheirJoints) {
  btMultiBody body(1, 1, btVector3(1, 1, 1), true, false);
  body.setupFixed(0, bt(2), btVector3(bt(0.1), bt(0.1), bt(0.1)), -1, btQuaternion::getIdentity(),
                  btVector3(bt(0.5), 0, 0), btVector3(bt(0.5), 0, 0));
  body.finalizeMultiDof();
  btMultiBodyJointFeedback feedback;
  body.getLink(0).m_jointFeedback = &feedback;
  world.world.addMultiBody(&body);
  world.world.setGravity({0, 0, bt(-10)});
  AttachDef def;
  def.fluid_body = std::make_shared<FluidBody>(facelessEllipsoid(Vector3(0.1, 0.1, 0.1)));
  def.medium = idealFluid(1000);
  def.fluid_frame.translation = {0, 0.2, 0};
  world.fluid.add(body, 0, def);
  world.step(1e-3, 2);
  const double lift = 1000 * def.fluid_body->volume * 10;
  const btVector3 force = feedback.m_reactionForces.m_topVec;
  const btVector3 torque = feedback.m_reactionForces.m_bottomVec;
  EXPECT_NEAR(static_cast<double>(force.z()), 20 - lift, 1e-4 * lift);
  EXPECT_NEAR(static_cast<double>(torque.x()), -0.2 * lift, 1e-4 * lift);
  world.world.removeMultiBody(&body);
}

// Joint forces of an arm with a motor: without fluid, or in next to none. It begins at rest: Bullet
// counts what is due to velocities once for forces and once more for rows.
std::vector<btSpatialForceVector> jointForces(bool is_in_fluid, bool in_world, bool in_joint) {
  Arbitrary arbitrary(9);
  RobotWorld world(is_in_fluid ? nullptr : std::make_unique<btMultiBodyConstraintSolver>());
  world.world.setGravity({0, 0, bt(-9.81)});
  world.world.getSolverInfo().m_jointFeedbackInWorldSpace = in_world;
  world.world.getSolverInfo().m_jointFeedbackInJointFrame = in_joint;
  RobotDef def;
  def.collider_radius = 0.02;
  def.speed = 0;
  def.has_fixed_base = true;
  btMultiBody& body = world.add(arbitrary, def);
  if (is_in_fluid) putIntoFluid(arbitrary, world, body, 1e-9);
  std::vector<btMultiBodyJointFeedback> feedback(3);
  for (int i = 0; i < 3; ++i) body.getLink(i).m_jointFeedback = &feedback[i];
  world.take(std::make_unique<btMultiBodyJointMotor>(&body, 1, bt(1), bt(1e-5)));
  world.step(1e-4, 3);
  std::vector<btSpatialForceVector> forces;
  for (const btMultiBodyJointFeedback& joint : feedback) forces.push_back(joint.m_reactionForces);
  return forces;
}

TEST_F(Robots, InThinFluidHaveTheJointForcesOfBullet) {
  for (const bool in_world : {false, true}) {
    for (const bool in_joint : {false, true}) {
      const auto expected = jointForces(false, in_world, in_joint);
      const auto forces = jointForces(true, in_world, in_joint);
      for (int i = 0; i < 3; ++i) {
        const btScalar size = expected[i].m_topVec.length();
        EXPECT_LT((forces[i].m_topVec - expected[i].m_topVec).length(), bt(1e-2) * size);
        EXPECT_LT((forces[i].m_bottomVec - expected[i].m_bottomVec).length(), bt(2e-3) * size);
      }
    }
  }
}

class OneShape : public FluidBodySource {
 public:
  std::shared_ptr<const FluidBody> fluidBody(const btCollisionShape&) override { return shape; }
  std::shared_ptr<const FluidBody> shape =
      std::make_shared<FluidBody>(facelessEllipsoid(Vector3(0.1, 0.1, 0.1)));
};

TEST_F(Robots, AreAttachedWithTheWorld) {
  RobotDef def;
  def.collider_radius = 0.05;
  btMultiBody& floating = add(def);
  def.has_fixed_base = true;
  btMultiBody& fixed = add(def);
  OneShape shapes;
  AttachSettings settings;
  settings.adjust_link = [&](const btMultiBody& body, int link, AttachDef& attach) {
    if (&body == &fixed && link == 2) attach.fluid_body = nullptr;
  };
  const AttachReport report = world.fluid.attachAll(world.world, shapes, water(), settings);
  EXPECT_EQ(report.attached, 6);
  EXPECT_TRUE(report.refused.empty()) << report.text();
  const AmbientRegistry& registry = world.fluid.registry();
  EXPECT_TRUE(registry.isAttached(floating, -1));
  EXPECT_TRUE(registry.isAttached(fixed, 1));
  EXPECT_FALSE(registry.isAttached(fixed, 2));
  EXPECT_FALSE(registry.isAttached(fixed, -1));
  EXPECT_EQ(world.fluid.attachAll(world.world, shapes, water(), settings).attached_before, 6);
}

TEST_F(Robots, SwimInRegions) {
  btMultiBody& body = add();
  putIntoFluid(arbitrary, world, body, 2);
  FluidRegion region;
  region.below = idealFluid(7);
  const RegionId id = world.fluid.addRegion(region);
  world.step(1e-3);
  EXPECT_EQ(world.fluid.registry().region(body, 2), id);
  EXPECT_EQ(world.fluid.registry().medium(body, -1).density, 7);
}

// The loads of water on links that motors keep at rest, or not, as PyBullet's.
TEST_F(Robots, StayBoundedUnderMotorsInWater) {
  RobotDef def;
  def.links = 4;
  def.collider_radius = 0.05;
  def.speed = 3;
  btMultiBody& body = add(def);
  AttachDef attach;
  attach.fluid_body = std::make_shared<FluidBody>(meshedEllipsoid(Vector3(0.15, 0.08, 0.05), 1));
  attach.medium = water();
  for (int link = -1; link < 4; ++link) world.fluid.add(body, link, attach);
  for (int i = 0; i < 4; ++i)
    world.take(std::make_unique<btMultiBodyJointMotor>(&body, i, bt(0), bt(1e-3)));
  const AmbientRegistry& registry = world.fluid.registry();
  double last = kineticEnergy(registry, body);
  const double start = last;
  for (int i = 0; i < 3600; ++i) {
    world.step(1 / 60.0);
    const double now = kineticEnergy(registry, body);
    ASSERT_LT(now, 1.001 * last + 1e-9 * start) << "step " << i;
    last = now;
  }
  EXPECT_LT(last, 1e-3 * start);
}

// Half as dense as water, let go at the surface.
TEST_F(Robots, FloatAtASurface) {
  world.world.setGravity({0, 0, bt(-9.81)});
  FluidRegion sea;
  sea.below = water();
  sea.below.viscosity = 0;
  sea.surface = std::make_shared<StillWater>(0, Vector3(0, 0, 1));
  world.fluid.addRegion(sea);
  const FluidBody box = floatingBox({0.4, 0.4, 0.2});
  const double mass = 0.5 * water().density * box.volume;
  btMultiBody body(0, bt(mass), bt(mass / 12) * btVector3(bt(0.2), bt(0.2), bt(0.32)), false,
                   false);
  body.setLinearDamping(bt(0.5));
  body.setAngularDamping(bt(0.5));
  body.finalizeMultiDof();
  body.setBasePos({0, 0, bt(0.05)});
  world.world.addMultiBody(&body);
  AttachDef def;
  def.fluid_body = std::make_shared<FluidBody>(box);
  def.medium = air();
  world.fluid.add(body, -1, def);
  world.step(1 / 240.0, 4800);
  EXPECT_NEAR(static_cast<double>(body.getBasePos().z()), 0, 5e-3);
  world.world.removeMultiBody(&body);
}

}  // namespace
}  // namespace ambient::test
