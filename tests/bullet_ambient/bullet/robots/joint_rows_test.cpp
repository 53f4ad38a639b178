#include <BulletDynamics/ConstraintSolver/btGeneric6DofSpring2Constraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyGearConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodySphericalJointMotor.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "tests/bullet_ambient/bullet/robots/link_reference.h"
#include "tests/bullet_ambient/bullet/robots/robot_world.h"

// Gears and motors of ball joints in fluid against one dense system of all links, joints and rows.
namespace ambient::test {
namespace {

RobotDef treeOfSmoothJoints(bool has_fixed_base) {
  RobotDef def;
  def.links = 7;
  def.joints = Joints::kSmooth;
  def.has_fixed_base = has_fixed_base;
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

TEST(JointRows, AMotorOfABallJointEqualsTheDenseSolution) {
  EXPECT_LT(worstOfBallMotors(1e9), kRowTolerance);
}

TEST(JointRows, AWeakMotorOfABallJointEqualsTheDenseSolution) {
  EXPECT_LT(worstOfBallMotors(0.03), kRowTolerance);
}

}  // namespace
}  // namespace ambient::test
