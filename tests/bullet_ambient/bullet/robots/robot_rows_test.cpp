#include <BulletDynamics/Featherstone/btMultiBodyJointLimitConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointMotor.h>
#include <BulletDynamics/Featherstone/btMultiBodyMLCPConstraintSolver.h>
#include <BulletDynamics/MLCPSolvers/btDantzigSolver.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "tests/bullet_ambient/bullet/robots/link_reference.h"

// Rows of links in fluid against one dense system of all links, joints and rows.
namespace ambient::test {
namespace {

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

TEST(RobotRows, OneContactEqualsTheDenseSolution) { expectImpacts({}, 0.5, 1); }

TEST(RobotRows, TwoContactsEqualTheDenseSolution) { expectImpacts({}, 0, 2); }

TEST(RobotRows, ContactsOfTreesWithAllJointsEqualTheDenseSolution) {
  RobotDef def;
  def.links = 7;
  def.joints = Joints::kAll;
  expectImpacts(def, 0.3, 2);
}

TEST(RobotRows, AFixedBaseEqualsTheDenseSolution) {
  RobotDef def;
  def.has_fixed_base = true;
  expectImpacts(def, 0.5, 1);
}

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

}  // namespace
}  // namespace ambient::test
