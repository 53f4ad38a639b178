#include <BulletDynamics/Featherstone/btMultiBodyJointFeedback.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointMotor.h>
#include <gtest/gtest.h>

#include "bullet_ambient/robot_dynamics.h"
#include "bullet_ambient/saved_state.h"
#include "tests/bullet_ambient/bullet/robots/robot_fixture.h"
#include "tests/bullet_ambient/bullet/robots/robot_world.h"
#include "tests/support/bodies/ellipsoid_body.h"
#include "tests/support/matrices.h"

// Joint forces, and forces for accelerations, including the fluid's.
namespace ambient::test {
namespace {

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
