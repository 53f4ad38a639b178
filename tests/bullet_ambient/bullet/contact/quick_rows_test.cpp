#include "bullet_ambient/bullet/rows/quick_rows.h"

#include <btBulletDynamicsCommon.h>
#include <gtest/gtest.h>

#include <cstring>
#include <random>

namespace ambient::test {
namespace {

// Rows between two bodies, or a body and what cannot move, by any numbers.
class RandomRows {
 public:
  btSolverBody body(bool moves) {
    btSolverBody body;
    std::memset(static_cast<void*>(&body), 0, sizeof body);
    if (moves) body.m_originalBody = &original_;
    for (btVector3* v : {&body.m_angularFactor, &body.m_linearFactor}) *v = {1, 1, 1};
    if (number() > 0) body.m_linearFactor = {1, 0, 1};
    const btScalar inverse_mass = moves ? 1 + number() * number() : 0;
    body.m_invMass = btVector3(1, 1, 1) * inverse_mass;
    if (moves) {
      body.m_deltaLinearVelocity = vector();
      body.m_deltaAngularVelocity = vector();
    }
    return body;
  }

  btSolverConstraint row() {
    btSolverConstraint row;
    std::memset(static_cast<void*>(&row), 0, sizeof row);
    for (btVector3* v :
         {&row.m_relpos1CrossNormal, &row.m_contactNormal1, &row.m_relpos2CrossNormal,
          &row.m_contactNormal2, &row.m_angularComponentA, &row.m_angularComponentB})
      *v = vector();
    row.m_appliedImpulse = number() * number();
    row.m_jacDiagABInv = btScalar(0.1) + number() * number();
    row.m_rhs = number();
    row.m_cfm = btScalar(0.1) * number();
    row.m_lowerLimit = number() > 0 ? -1 : 0;
    row.m_upperLimit = number() > 0 ? btScalar(0.2) : btScalar(1e10);
    row.m_friction = btScalar(0.5);
    return row;
  }

 private:
  btScalar number() { return static_cast<btScalar>(normal_(engine_)); }
  btVector3 vector() {
    const btScalar x = number(), y = number(), z = number();
    return {x, y, z};
  }

  std::mt19937 engine_{7};
  std::normal_distribution<double> normal_;
  btSphereShape sphere_{1};
  btRigidBody original_{1, nullptr, &sphere_};
};

bool isSame(btScalar a, btScalar b) { return std::memcmp(&a, &b, sizeof a) == 0; }

bool isSame(const btVector3& a, const btVector3& b) {
  return isSame(a.x(), b.x()) && isSame(a.y(), b.y()) && isSame(a.z(), b.z());
}

bool isSame(const btSolverBody& a, const btSolverBody& b) {
  return isSame(a.m_deltaLinearVelocity, b.m_deltaLinearVelocity) &&
         isSame(a.m_deltaAngularVelocity, b.m_deltaAngularVelocity);
}

// Expects the bits of Bullet's function.
void expectSame(btSingleConstraintRowSolver quick, btSingleConstraintRowSolver stock) {
  RandomRows random;
  for (int i = 0; i < 2000; ++i) {
    const btSolverBody bodies[2] = {random.body(true), random.body(i % 4 != 0)};
    const btSolverConstraint given = random.row();
    btSolverBody a[2] = {bodies[0], bodies[0]}, b[2] = {bodies[1], bodies[1]};
    const btSolverConstraint row[2] = {given, given};
    const btScalar residuals[2] = {stock(a[0], b[0], row[0]), quick(a[1], b[1], row[1])};
    ASSERT_TRUE(isSame(residuals[0], residuals[1])) << "residual of row " << i;
    ASSERT_TRUE(isSame(row[0].m_appliedImpulse, row[1].m_appliedImpulse)) << "impulse of row " << i;
    ASSERT_TRUE(isSame(a[0], a[1]) && isSame(b[0], b[1])) << "velocities of row " << i;
  }
}

TEST(QuickRows, HaveTheBitsOfBullets) {
  btSequentialImpulseConstraintSolver solver;
  expectSame(quickRows().generic, solver.getScalarConstraintRowSolverGeneric());
  expectSame(quickRows().lower_limit, solver.getScalarConstraintRowSolverLowerLimit());
}

}  // namespace
}  // namespace ambient::test
