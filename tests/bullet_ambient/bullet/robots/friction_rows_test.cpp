#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "tests/bullet_ambient/bullet/robots/link_reference.h"

// Friction of links in fluid, and kinematic links, against one dense system of all links, joints
// and rows.
namespace ambient::test {
namespace {

constexpr double kFriction = 0.4;

// Normal that opposes the velocity of a link, obliquely.
btVector3 slopeBelow(const DenseVector6& twist) {
  const btVector3 velocity(bt(double(twist[3])), bt(double(twist[4])), bt(double(twist[5])));
  btVector3 across, other;
  btPlaneSpace1(velocity.normalized(), across, other);
  return (bt(0.9) * across - velocity.normalized()).normalized();
}

struct Frictions {
  double worst = 0;  // error of twists
  int robots = 0, stick = 0, slip = 0;
};

// Tells if the solution has an open contact. Bullet stops updating friction when a contact opens
// during its iterations, and keeps the last value; not compared.
bool hasOpenContact(const DenseRobot& robot, const reference::DenseSolution& solution) {
  for (const reference::DenseRow& row : robot.rows)
    if (row.normal_row >= 0 && !(solution.impulses[row.normal_row] > 0)) return true;
  return false;
}

void countFrictions(const DenseRobot& robot, const reference::DenseSolution& solution,
                    Frictions& frictions) {
  for (std::size_t i = 0; i < robot.rows.size(); ++i) {
    const reference::DenseRow& row = robot.rows[i];
    if (row.normal_row < 0) continue;
    const Real bound = row.friction * solution.impulses[row.normal_row];
    const bool slips = std::abs(solution.impulses[i]) > bound * (1 - 1e-9L);
    ++(slips ? frictions.slip : frictions.stick);
  }
}

void rub(unsigned seed, const RobotDef& def, int directions, Frictions& frictions) {
  Arbitrary arbitrary(seed);
  RobotWorld world;
  btMultiBody& body = world.add(arbitrary, def);
  putIntoFluid(arbitrary, world, body, 5);
  // One friction direction, or two independent ones.
  int& mode = world.world.getSolverInfo().m_solverMode;
  mode |= SOLVER_DISABLE_IMPLICIT_CONE_FRICTION;
  if (directions == 1) mode &= ~SOLVER_USE_2_FRICTION_DIRECTIONS;
  const std::vector<DenseVector6> before = twistsOf(body);
  const int link = def.has_fixed_base || seed % 2 ? body.getNumLinks() - 1 : -1;
  body.getBaseCollider()->setFriction(bt(kFriction));
  for (int i = 0; i < body.getNumLinks(); ++i) body.getLinkCollider(i)->setFriction(bt(kFriction));
  addFloor(world, body, link, slopeBelow(before[link + 1]), 0.5).setFriction(1);
  DenseRobot robot = denseRobot(body, world.fluid);
  world.step(kMoment);
  addContacts(world, body, before, {0.5, double(bt(kFriction)), directions}, robot);
  // Friction may allow several solutions: one per contact that opens or slides.
  const auto expected = reference::onlySolution(robot.bodies, robot.rows);
  if (!expected) return;
  if (hasOpenContact(robot, *expected)) return;
  ++frictions.robots;
  countFrictions(robot, *expected, frictions);
  frictions.worst = std::max(frictions.worst, twistError(body, expected->velocities, before));
}

void expectFriction(RobotDef def, int directions) {
  def.collider_radius = kSphereRadius;
  Frictions frictions;
  for (unsigned seed = 0; seed < 20; ++seed) rub(seed, def, directions, frictions);
  EXPECT_GE(frictions.robots, 15);
  EXPECT_GE(frictions.stick, 3);
  EXPECT_GE(frictions.slip, 3);
  EXPECT_LT(frictions.worst, kRowTolerance);
}

TEST(FrictionRows, OneDirectionEqualsTheDenseSolution) { expectFriction({}, 1); }

TEST(FrictionRows, TwoDirectionsEqualTheDenseSolution) { expectFriction({}, 2); }

TEST(FrictionRows, TreesWithAllJointsEqualTheDenseSolution) {
  RobotDef def;
  def.links = 5;
  def.joints = Joints::kAll;
  expectFriction(def, 1);
}

TEST(FrictionRows, AFixedBaseEqualsTheDenseSolution) {
  RobotDef def;
  def.has_fixed_base = true;
  expectFriction(def, 1);
}

// Kinematic base and first link, and a tip that hits a floor.
TEST(FrictionRows, KinematicLinksEqualTheDenseSolution) {
  double worst = 0;
  RobotDef def;
  def.collider_radius = kSphereRadius;
  for (unsigned seed = 0; seed < 10; ++seed) {
    Arbitrary arbitrary(seed);
    RobotWorld world;
    btMultiBody& body = world.add(arbitrary, def);
    for (int link : {-1, 0}) body.setLinkDynamicType(link, btCollisionObject::CF_KINEMATIC_OBJECT);
    for (int link : {0, 1, 2}) world.fluid.add(body, link, coupledFluid(arbitrary, body, link, 5));
    const std::vector<DenseVector6> before = twistsOf(body);
    addFloor(world, body, 2, slopeBelow(before[3]), 0.5);
    DenseRobot robot = denseRobot(body, world.fluid);
    driveBase(body, robot);
    robot.rows.push_back(rateRow(body, 0));
    robot.rows.back().target = body.getJointVel(0);
    world.step(kMoment);
    addContacts(world, body, before, ContactLaw{0.5}, robot);
    const auto expected = reference::solveDense(robot.bodies, robot.rows);
    EXPECT_GT(twistError(body, before, before), 1e-3);  // the tip has hit
    worst = std::max(worst, twistError(body, expected.velocities, before));
  }
  EXPECT_LT(worst, kRowTolerance);
}

}  // namespace
}  // namespace ambient::test
