#include <BulletDynamics/Featherstone/btMultiBodyConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>

#include "bullet_ambient/bullet/links/multibody_rows.h"
#include "tests/bullet_ambient/bullet/robots/robot_world.h"

namespace ambient::test {
namespace {

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
