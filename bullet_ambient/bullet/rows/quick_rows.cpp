#include "bullet_ambient/bullet/core/four_numbers.h"
#include "bullet_ambient/bullet/rows/constraint_rows.h"

AMBIENT_BEGIN
namespace {

// Returns ds, the change of the row's impulse before it is limited.
AMBIENT_INLINE btScalar lackingImpulse(const btSolverBody& a, const btSolverBody& b,
                                       const btSolverConstraint& row) {
  const Four along = sumsOfThree(load(row.m_contactNormal1) * load(a.m_deltaLinearVelocity),
                                 load(row.m_relpos1CrossNormal) * load(a.m_deltaAngularVelocity),
                                 load(row.m_contactNormal2) * load(b.m_deltaLinearVelocity),
                                 load(row.m_relpos2CrossNormal) * load(b.m_deltaAngularVelocity));
  const btScalar j = row.m_jacDiagABInv;
  btScalar lacking = row.m_rhs - btScalar(row.m_appliedImpulse) * row.m_cfm;
  lacking -= (along[0] + along[1]) * j;
  lacking -= (along[2] + along[3]) * j;
  return lacking;
}

template <bool kHasUpperLimit>
AMBIENT_INLINE btScalar solve(btSolverBody& a, btSolverBody& b, const btSolverConstraint& row) {
  btScalar impulse = lackingImpulse(a, b, row);
  const btScalar applied = row.m_appliedImpulse;
  btScalar sum = applied + impulse;
  if (sum < row.m_lowerLimit) {
    sum = row.m_lowerLimit;
    impulse = sum - applied;
  } else if (kHasUpperLimit && sum > row.m_upperLimit) {
    sum = row.m_upperLimit;
    impulse = sum - applied;
  }
  row.m_appliedImpulse = sum;
  applyImpulse(a, row.m_contactNormal1, row.m_angularComponentA, impulse);
  applyImpulse(b, row.m_contactNormal2, row.m_angularComponentB, impulse);
  return static_cast<btScalar>(static_cast<double>(impulse) *
                               (1. / static_cast<double>(row.m_jacDiagABInv)));
}

AMBIENT_INLINE btScalar solveIn(const RowPass& pass, const btSolverConstraint& row,
                                bool has_upper_limit, btScalar largest) {
  btSolverBody &a = pass.bodies[row.m_solverBodyIdA], &b = pass.bodies[row.m_solverBodyIdB];
  const btScalar residual = has_upper_limit ? solve<true>(a, b, row) : solve<false>(a, b, row);
  return btMax(largest, residual * residual);
}

AMBIENT_INLINE btScalar solveJoints(const RowPass& pass, int iteration, btScalar largest) {
  for (int i = 0; i < pass.rows.size(); ++i) {
    const btSolverConstraint& row = pass.rows[pass.order[i]];
    if (iteration < row.m_overrideNumSolverIterations) largest = solveIn(pass, row, true, largest);
  }
  return largest;
}

AMBIENT_INLINE btScalar solveContacts(const RowPass& pass, btScalar largest) {
  for (int i = 0; i < pass.rows.size(); ++i)
    largest = solveIn(pass, pass.rows[pass.order[i]], false, largest);
  return largest;
}

AMBIENT_INLINE btScalar solveFrictions(const RowPass& pass, const btConstraintArray& contacts,
                                       btScalar largest) {
  for (int i = 0; i < pass.rows.size(); ++i) {
    btSolverConstraint& row = pass.rows[pass.order[i]];
    const btScalar pressed = contacts[row.m_frictionIndex].m_appliedImpulse;
    if (!(pressed > 0)) continue;
    row.m_lowerLimit = -(row.m_friction * pressed);
    row.m_upperLimit = row.m_friction * pressed;
    largest = solveIn(pass, row, true, largest);
  }
  return largest;
}

}  // namespace

const QuickRows& quickRows() noexcept {
  static const QuickRows fastest{fastestCopy<&solve<true>>(), fastestCopy<&solve<false>>(),
                                 fastestCopy<&solveContacts>(), fastestCopy<&solveFrictions>(),
                                 fastestCopy<&solveJoints>()};
  return fastest;
}

AMBIENT_END
