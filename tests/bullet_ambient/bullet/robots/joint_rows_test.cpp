#include <BulletDynamics/ConstraintSolver/btGeneric6DofSpring2Constraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyGearConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodySphericalJointMotor.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <utility>

#include "bullet_ambient/bullet/rows/constraint_rows.h"
#include "tests/bullet_ambient/bullet/robots/link_reference.h"
#include "tests/bullet_ambient/bullet/robots/robot_world.h"

namespace ambient::test {
namespace {

// Gears and motors of ball joints in fluid against one dense system of all links, joints and rows.

RobotDef treeOfSmoothJoints(bool has_fixed_base) {
  RobotDef def{7, Joints::kSmooth, has_fixed_base};
  def.collider_radius = 0.01;
  return def;
}

// Largest error of 12 robots. `addRows(world, body, robot)` adds constraints to the world, and
// equal rows to the robot. Even seeds: floating base, odd: fixed.
template <class AddRows>
double worstRobotError(const AddRows& addRows) {
  double worst = 0;
  for (unsigned seed = 0; seed < 12; ++seed) {
    Arbitrary arbitrary(seed);
    RobotWorld world;
    btMultiBody& body = world.add(arbitrary, treeOfSmoothJoints(seed % 2 == 1));
    putIntoFluid(arbitrary, world, body, 5);
    world.world.getSolverInfo().m_erp = 1;
    DenseRobot robot = denseRobot(body, world.fluid);
    const std::vector<DenseVector6> before = twistsOf(body);
    addRows(world, body, robot);
    const auto expected = reference::solveDense(robot.bodies, robot.rows);
    world.step(kMoment);
    EXPECT_GT(twistError(body, before, before), 1e-3);  // the rows act
    worst = std::max(worst, twistError(body, expected.velocities, before));
  }
  return worst;
}

constexpr double kRatio = -1.7;

void addGear(RobotWorld& world, btMultiBody& body, int link_a, int link_b, double erp, int aux) {
  const btVector3 none(0, 0, 0);
  auto gear = std::make_unique<btMultiBodyGearConstraint>(&body, link_a, &body, link_b, none, none,
                                                          btMatrix3x3::getIdentity(),
                                                          btMatrix3x3::getIdentity());
  gear->setGearRatio(bt(kRatio));
  gear->setErp(bt(erp));
  gear->setRelativePositionTarget(bt(0.3));
  gear->setGearAuxLink(aux);
  gear->setMaxAppliedImpulse(bt(1e9));
  world.take(std::move(gear));
}

// Gears between branches. Links 0 and 4 turn, 1 and 5 slide.
TEST(JointRows, GearsEqualTheDenseSolution) {
  const double worst = worstRobotError([](RobotWorld& world, btMultiBody& body, DenseRobot& robot) {
    for (const auto& [a, b] : {std::pair{0, 4}, std::pair{5, 1}}) {
      addGear(world, body, a, b, 0, -1);
      robot.rows.push_back(reference::gearRow(rateRow(body, a), kRatio, rateRow(body, b)));
    }
  });
  EXPECT_LT(worst, kRowTolerance);
}

// Gear of a differential: adds the rate of a third joint, and corrects a part of the error.
TEST(JointRows, AGearWithAThirdJointEqualsTheDenseSolution) {
  const double worst = worstRobotError([](RobotWorld& world, btMultiBody& body, DenseRobot& robot) {
    addGear(world, body, 4, 1, kMoment, 0);
    reference::DenseRow row = reference::gearRow(rateRow(body, 4), kRatio, rateRow(body, 1));
    const Real error =
        Real(body.getJointPos(4) - body.getJointPos(0)) + Real(kRatio) * body.getJointPos(1);
    row.target = Real(body.getJointVel(0)) + Real(0.3) - error;
    robot.rows.push_back(row);
  });
  EXPECT_LT(worst, kRowTolerance);
}

constexpr int kBall = 2;
const btQuaternion kAim(btVector3(bt(0.6), 0, bt(0.8)), bt(0.5));

// Bullet's Euler angles of the turn from the joint's position to kAim, about the link's axes.
btVector3 wayToAim(const btMultiBody& body) {
  const btScalar* q = body.getJointPosMultiDof(kBall);
  btVector3 angles;
  btGeneric6DofSpring2Constraint::matrixToEulerXYZ(
      btMatrix3x3(btQuaternion(q[0], q[1], q[2], q[3]).inverse() * kAim), angles);
  return angles;
}

double worstOfBallMotors(double strength) {
  return worstRobotError([strength](RobotWorld& world, btMultiBody& body, DenseRobot& robot) {
    const btVector3 damping(bt(0.5), 1, bt(0.8));
    auto motor = std::make_unique<btMultiBodySphericalJointMotor>(&body, kBall, bt(strength));
    motor->setPositionTarget(kAim, bt(kMoment));
    motor->setDamping(damping);
    world.take(std::move(motor));
    const DenseVector6 parent = robot.bodies[body.getLink(kBall).m_parent + 1].free_velocity;
    const DenseVector6 link = robot.bodies[kBall + 1].free_velocity;
    for (int axis = 0; axis < 3; ++axis) {
      reference::DenseRow row = turnRow(body, kBall, axis);
      const Real rate = row.jacobian_a.dot(link) + row.jacobian_b.dot(parent);
      row.target = (1 - Real(damping[axis])) * rate - Real(wayToAim(body)[axis]);
      row.lower = -Real(strength);
      row.upper = Real(strength);
      robot.rows.push_back(row);
    }
  });
}

TEST(JointRows, StrongAndWeakMotorsOfABallJointEqualTheDenseSolution) {
  for (const double strength : {1e9, 0.03}) EXPECT_LT(worstOfBallMotors(strength), kRowTolerance);
}

// Friction of links in fluid, and kinematic links, against one dense system of all links, joints
// and rows.

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
  RobotDef def{5, Joints::kAll};
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

// Two friction rows between a robot of three links and a rigid body, with arbitrary numbers.
class FrictionTask : public btMultiBodyConstraintSolver {
 public:
  FrictionTask(unsigned seed, double size, double limit) {
    Arbitrary arbitrary(seed);
    robot_ = arbitraryRobot(arbitrary, {});
    const int dofs = robot_->getNumDofs() + 6;
    const auto fill = [&](btAlignedObjectArray<btScalar>& numbers, int count) {
      for (int i = 0; i < count; ++i) numbers.push_back(bt(arbitrary.between(-1, 1)));
    };
    fill(m_data.m_jacobians, 2 * dofs);
    fill(m_data.m_deltaVelocitiesUnitImpulse, 2 * dofs);
    m_data.m_deltaVelocities.resize(dofs);
    for (int i = 0; i < dofs; ++i)
      m_data.m_deltaVelocities[i] = bt(size * arbitrary.between(-1, 1));
    const btRigidBody::btRigidBodyConstructionInfo info(1, nullptr, nullptr, {1, 1, 1});
    rigid_ = std::make_unique<btRigidBody>(info);
    initSolverBody(&m_tmpSolverBodyPool.expandNonInitializing(), rigid_.get(), bt(0.01));
    for (int i = 0; i < 2; ++i) {
      btMultiBodySolverConstraint& row = rows[i];
      row.m_multiBodyA = robot_.get();
      row.m_jacAindex = i * dofs;
      row.m_deltaVelAindex = 0;
      row.m_solverBodyIdB = 0;
      row.m_contactNormal2 = toBullet(arbitrary.vector());
      row.m_relpos2CrossNormal = toBullet(arbitrary.vector());
      row.m_angularComponentB = toBullet(arbitrary.vector());
      row.m_jacDiagABInv = bt(arbitrary.between(0.1, 1));
      row.m_rhs = bt(size * arbitrary.between(-1, 1));
      row.m_cfm = bt(arbitrary.between(0, 0.1));
      row.m_appliedImpulse = bt(0.3 * limit * arbitrary.between(-1, 1));
      row.m_upperLimit = bt(limit);
      row.m_lowerLimit = -row.m_upperLimit;
    }
  }

  btScalar solveAsBullet() { return resolveConeFrictionConstraintRows(rows[0], rows[1]); }
  btScalar solveAsWe() { return solveFrictionPair(rows[0], rows[1], m_data, m_tmpSolverBodyPool); }

  // Impulses, and the velocity changes of both bodies.
  Eigen::VectorXd result() {
    const int dofs = robot_->getNumDofs() + 6;
    Eigen::VectorXd all(2 + 2 * dofs + 6);
    for (int i = 0; i < 2; ++i) all[i] = static_cast<double>(rows[i].m_appliedImpulse);
    for (int i = 0; i < dofs; ++i) {
      all[2 + i] = static_cast<double>(m_data.m_deltaVelocities[i]);
      all[2 + dofs + i] = static_cast<double>(robot_->getDeltaVelocityVector()[i]);
    }
    all.segment<3>(2 + 2 * dofs) =
        toVector3(m_tmpSolverBodyPool[0].internalGetDeltaLinearVelocity());
    all.tail<3>() = toVector3(m_tmpSolverBodyPool[0].internalGetDeltaAngularVelocity());
    return all;
  }

  btMultiBodySolverConstraint rows[2];

 private:
  std::unique_ptr<btMultiBody> robot_;
  std::unique_ptr<btRigidBody> rigid_;
};

// Rounding of sums of 18 products.
const double kSumRounding = byPrecision(1e-14, 1e-5);

TEST(ConeFriction, HasTheImpulsesOfBullet) {
  int inside = 0, outside = 0;
  for (unsigned seed = 0; seed < 200; ++seed) {
    for (const double limit : {0.2, 1.0, 5.0}) {
      FrictionTask bullet(seed, 1, limit), ours(seed, 1, limit);
      const auto expected = static_cast<double>(bullet.solveAsBullet());
      EXPECT_NEAR(static_cast<double>(ours.solveAsWe()), expected,
                  kSumRounding * 100 * (1 + std::abs(expected)));
      EXPECT_LT((ours.result() - bullet.result()).norm(), kSumRounding * bullet.result().norm());
      const double share = ours.result().head<2>().norm() / limit;
      EXPECT_LT(share, 1 + kSumRounding);
      ++(share < 1 - kSumRounding ? inside : outside);
    }
  }
  EXPECT_GT(inside, 50);
  EXPECT_GT(outside, 50);
}

// Without a limit nothing is divided by zero, and squares of tiny impulses vanish.
TEST(ConeFriction, HoldsAtZeroAndTinyImpulses) {
  const double tiny = byPrecision(1e-200, 1e-30);
  for (const double limit : {0.0, 0.1 * tiny}) {
    FrictionTask task(3, tiny, limit);
    task.solveAsWe();
    const Eigen::VectorXd result = task.result();
    EXPECT_TRUE(result.allFinite());
    EXPECT_NEAR(result.head<2>().stableNorm(), limit, kSumRounding * limit);
  }
}

TEST(ConeFriction, LetsWhatIsNotANumberThrough) {
  FrictionTask task(3, 1, 1);
  task.rows[0].m_rhs = std::numeric_limits<btScalar>::quiet_NaN();
  task.solveAsWe();
  EXPECT_TRUE(std::isnan(task.result()[0]));
}

}  // namespace
}  // namespace ambient::test
