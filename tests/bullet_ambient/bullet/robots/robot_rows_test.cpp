#include <BulletDynamics/Featherstone/btMultiBodyJointFeedback.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointLimitConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointMotor.h>
#include <BulletDynamics/Featherstone/btMultiBodyMLCPConstraintSolver.h>
#include <BulletDynamics/MLCPSolvers/btDantzigSolver.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "bullet_ambient/robot_dynamics.h"
#include "bullet_ambient/saved_state.h"
#include "tests/bullet_ambient/bullet/robots/link_reference.h"
#include "tests/bullet_ambient/bullet/robots/robot_world.h"
#include "tests/support/bodies/ellipsoid_body.h"
#include "tests/support/matrices.h"

namespace ambient::test {
namespace {

// Rows of links in fluid against one dense system of all links, joints and rows.

struct Impact {
  double error = 0;
  int contacts = 0;
};

Impact hit(unsigned seed, const RobotDef& def, double restitution, int floors) {
  Arbitrary arbitrary(seed);
  RobotWorld world;
  btMultiBody& body = world.add(arbitrary, def);
  putIntoFluid(arbitrary, world, body, 5);
  const int tip = body.getNumLinks() - 1;
  const btVector3 down = -body.getBaseVel().normalized();
  if (!def.has_fixed_base) addFloor(world, body, -1, down, restitution);
  if (def.has_fixed_base || floors > 1)
    addFloor(world, body, tip, btVector3(0, bt(0.6), bt(0.8)), restitution);
  DenseRobot robot = denseRobot(body, world.fluid);
  const std::vector<DenseVector6> before = twistsOf(body);
  world.step(kMoment);
  const auto rows_of_joints = robot.rows.size();
  addContacts(world, body, before, ContactLaw{restitution}, robot);
  const auto expected = reference::solveDense(robot.bodies, robot.rows);
  return {twistError(body, expected.velocities, before),
          static_cast<int>(robot.rows.size() - rows_of_joints)};
}

void expectImpacts(RobotDef def, double restitution, int floors) {
  double worst = 0;
  int hits = 0;
  def.collider_radius = kSphereRadius;
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Impact impact = hit(seed, def, restitution, floors);
    if (impact.contacts == 0) continue;
    ++hits;
    worst = std::max(worst, impact.error);
  }
  EXPECT_GE(hits, 15);
  EXPECT_LT(worst, kRowTolerance);
}

TEST(RobotRows, TwoContactsEqualTheDenseSolution) { expectImpacts({}, 0, 2); }

// Bullet has no articulated inertia for a base without links.
TEST(RobotRows, ABaseAloneEqualsTheDenseSolution) {
  RobotDef def;
  def.links = 0;
  expectImpacts(def, 0.5, 1);
}

Eigen::VectorXd velocityAfterHit(unsigned seed, RobotWorld& world) {
  Arbitrary arbitrary(seed);
  RobotDef def;
  def.collider_radius = kSphereRadius;
  btMultiBody& body = world.add(arbitrary, def);
  for (int link = -1; link < 3; ++link)
    world.fluid.add(body, link, coupledFluid(arbitrary, body, link, 5));
  addFloor(world, body, -1, -body.getBaseVel().normalized(), 0.5);
  world.step(kMoment);
  return velocityOf(body);
}

TEST(RobotRows, AComplementaritySolverFindsTheSame) {
  for (unsigned seed = 0; seed < 5; ++seed) {
    RobotWorld by_iterations;
    const Eigen::VectorXd expected = velocityAfterHit(seed, by_iterations);
    btDantzigSolver inner;
    RobotWorld world;
    const auto solver = makeSolver<btMultiBodyMLCPConstraintSolver>(world.fluid, &inner);
    world.world.setMultiBodyConstraintSolver(solver.get());
    const Eigen::VectorXd u = velocityAfterHit(seed, world);
    EXPECT_LT(relativeError(u, expected), byPrecision(1e-8, 1e-4));
    EXPECT_GT(world.fluid.counters().rows, 0);
  }
}

// Warm starts repeat impulses of the last step, applied by Bullet with the dry response.
TEST(RobotRows, WarmStartsChangeNothingButTheWay) {
  Eigen::VectorXd ends[2];
  for (const int mode : {0, int(SOLVER_USE_ARTICULATED_WARMSTARTING)}) {
    Arbitrary arbitrary(3);
    RobotWorld world;
    world.world.setGravity({0, 0, bt(-9.8)});
    world.world.getSolverInfo().m_solverMode |= mode;
    RobotDef def;
    def.collider_radius = 0.06;
    btMultiBody& body = world.add(arbitrary, def);
    putIntoFluid(arbitrary, world, body, 2);
    world.addFixed(std::make_unique<btStaticPlaneShape>(btVector3(0, 0, 1), bt(-1.2)),
                   btTransform::getIdentity());
    world.take(std::make_unique<btMultiBodyJointMotor>(&body, 1, bt(1), bt(0.02)));
    world.step(1 / 240.0, 120);
    ends[mode != 0] = velocityOf(body);
  }
  EXPECT_LT(relativeError(ends[1], ends[0]), byPrecision(1e-7, 1e-2));
}

TEST(RobotRows, AMotorAndALimitEqualTheDenseSolution) {
  double worst = 0;
  for (unsigned seed = 0; seed < 10; ++seed) {
    Arbitrary arbitrary(seed);
    RobotWorld world;
    RobotDef def;
    def.collider_radius = 0.01;
    btMultiBody& body = world.add(arbitrary, def);
    putIntoFluid(arbitrary, world, body, 5);
    body.setJointVel(0, bt(-1.5));
    world.take(std::make_unique<btMultiBodyJointMotor>(&body, 1, bt(3), bt(1e9)));
    auto limit = std::make_unique<btMultiBodyJointLimitConstraint>(&body, 0, body.getJointPos(0),
                                                                   body.getJointPos(0) + 3);
    limit->setMaxAppliedImpulse(bt(1e9));
    world.take(std::move(limit));
    DenseRobot robot = denseRobot(body, world.fluid);
    const std::vector<DenseVector6> before = twistsOf(body);
    robot.rows.push_back(rateRow(body, 1));
    robot.rows.back().target = 3;
    robot.rows.push_back(rateRow(body, 0));
    robot.rows.back().lower = 0;
    const auto expected = reference::solveDense(robot.bodies, robot.rows);
    world.step(kMoment);
    worst = std::max(worst, twistError(body, expected.velocities, before));
  }
  EXPECT_LT(worst, kRowTolerance);
}

// Joint forces, and forces for accelerations, including the fluid's.

TEST_F(Robots, TellTheMassMatrixAndTheForcesOfAnAcceleration) {
  btMultiBody& body = add();
  putIntoFluid(arbitrary, world, body, 2);
  world.world.setGravity({0, 0, bt(-9.81)});
  const Fluid& fluid = world.fluid;
  const Eigen::MatrixXd H = ambientMassMatrix(fluid, body);
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(9), some = Eigen::VectorXd::Random(9);
  const Eigen::VectorXd change =
      ambientInverseDynamics(fluid, body, some) - ambientInverseDynamics(fluid, body, none);
  EXPECT_LT(relativeError(change, H * some), 1e-12);
  const Eigen::VectorXd u = velocityOf(body);
  EXPECT_NEAR(kineticEnergy(fluid, body), u.dot(H * u) / 2, 1e-12 * u.dot(H * u));
  EXPECT_THROW(ambientInverseDynamics(fluid, body, Eigen::VectorXd::Zero(8)),
               std::invalid_argument);
  // What it does without any force, for a moment.
  const Eigen::VectorXd rate = solve(H, -ambientInverseDynamics(fluid, body, none));
  const double moment = byPrecision(1e-7, 1e-3);
  world.step(moment);
  const Eigen::VectorXd after = (velocityOf(body) - u) / moment;
  EXPECT_LT(relativeError(after, rate), byPrecision(1e-5, 1e-2));
}

// A link of volume V on a fixed joint: weight and buoyancy.
TEST_F(Robots, FeelBuoyancyInTheirJoints) {
  btMultiBody body(1, 1, btVector3(1, 1, 1), true, false);
  body.setupFixed(0, bt(2), btVector3(bt(0.1), bt(0.1), bt(0.1)), -1, btQuaternion::getIdentity(),
                  btVector3(bt(0.5), 0, 0), btVector3(bt(0.5), 0, 0));
  body.finalizeMultiDof();
  btMultiBodyJointFeedback feedback;
  body.getLink(0).m_jointFeedback = &feedback;
  world.world.addMultiBody(&body);
  world.world.setGravity({0, 0, bt(-10)});
  AttachDef def{std::make_shared<FluidBody>(facelessEllipsoid(Vector3(0.1, 0.1, 0.1))),
                idealFluid(1000)};
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

// Joint forces of an arm with a motor, without fluid or in a very thin one. Starts at rest: Bullet
// counts velocity terms twice, in forces and in rows.
std::vector<btSpatialForceVector> jointForces(bool is_in_fluid, bool in_world, bool in_joint) {
  Arbitrary arbitrary(9);
  RobotWorld world;
  btMultiBodyConstraintSolver stock;
  if (!is_in_fluid) world.world.setMultiBodyConstraintSolver(&stock);
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

TEST(ImmersedLink, StaysValidWhenAStateIsRestored) {
  Arbitrary arbitrary(3);
  RobotWorld robots;
  btMultiBody& robot = robots.add(arbitrary, {});
  const Immersed stays = robots.fluid.add(robot, 1, coupledFluid(arbitrary, robot, 1, 2));
  const WorldState state = robots.fluid.save();
  const Immersed leaves = robots.fluid.add(robot, 0, coupledFluid(arbitrary, robot, 0, 2));
  robots.step(kWorldStep);
  robots.fluid.restore(state);
  EXPECT_TRUE(stays.isValid());
  EXPECT_EQ(stays.medium().density, 1);
  EXPECT_FALSE(leaves.isValid());
}

// Compares with H^-1 J^T of the dense mass matrix H; J^T of the base is the identity.
TEST(ImmersedLink, AnImpulseMovesAllLinksOfATree) {
  Arbitrary arbitrary(9);
  RobotWorld robots;
  RobotDef def;
  def.speed = 0;
  btMultiBody& robot = robots.add(arbitrary, def);
  putIntoFluid(arbitrary, robots, robot, 3);
  const Wrench impulse{{0.3, -0.2, 0.1}, {1, 2, 3}};
  Eigen::VectorXd force = Eigen::VectorXd::Zero(6 + robot.getNumDofs());
  force.head<6>() = impulse.vector();
  robots.fluid.find(robot, -1)->applyImpulse(impulse);
  const Eigen::VectorXd expected = solve(ambientMassMatrix(robots.fluid, robot), force);
  EXPECT_LT(relativeError(velocityOf(robot), expected), byPrecision(1e-12, 1e-5));
}

// A link's momentum, with that of all others, changes by the impulse: the sum over all links is
// what the base's coordinates have in H u.
TEST(ImmersedLink, AnImpulseChangesTheMomentumOfItsTree) {
  Arbitrary arbitrary(11);
  RobotWorld robots;
  RobotDef def;
  def.speed = 0;
  btMultiBody& robot = robots.add(arbitrary, def);
  putIntoFluid(arbitrary, robots, robot, 3);
  const Wrench impulse{Vector3::Zero(), {1, 2, 3}};
  robots.fluid.find(robot, 2)->applyImpulse(impulse);
  const Eigen::VectorXd momentum = ambientMassMatrix(robots.fluid, robot) * velocityOf(robot);
  EXPECT_LT((momentum.segment<3>(3) - impulse.force).norm(), byPrecision(1e-11, 1e-4));
  const btVector3 arm = robot.localPosToWorld(2, btVector3(0, 0, 0)) - robot.getBasePos();
  const Vector3 torque = toVector3(arm).cross(impulse.force);
  EXPECT_LT((momentum.head<3>() - torque).norm(), byPrecision(1e-11, 1e-4));
}

}  // namespace
}  // namespace ambient::test
