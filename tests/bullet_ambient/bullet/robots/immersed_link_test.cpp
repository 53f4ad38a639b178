#include <gtest/gtest.h>

#include "bullet_ambient/robot_dynamics.h"
#include "bullet_ambient/saved_state.h"
#include "tests/bullet_ambient/bullet/robots/robot_world.h"
#include "tests/support/matrices.h"

namespace ambient::test {
namespace {

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
