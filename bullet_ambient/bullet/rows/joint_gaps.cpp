#include "bullet_ambient/bullet/rows/joint_gaps.h"

#include <algorithm>
#include <cmath>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/bullet/members/ambient_bodies.h"

AMBIENT_BEGIN

namespace {

// Returns the velocity along the row before the impulses of the step, including the velocity change
// by external forces [m/s].
btScalar velocityBefore(const btSolverConstraint& row, const btSolverBody& a,
                        const btSolverBody& b) {
  return row.m_contactNormal1.dot(a.m_linearVelocity + a.m_externalForceImpulse) +
         row.m_relpos1CrossNormal.dot(a.m_angularVelocity + a.m_externalTorqueImpulse) +
         row.m_contactNormal2.dot(b.m_linearVelocity + b.m_externalForceImpulse) +
         row.m_relpos2CrossNormal.dot(b.m_angularVelocity + b.m_externalTorqueImpulse);
}

// Returns the velocity of Bullet's position correction [m/s]: the right-hand side plus the velocity
// along the row. Returns 0 for a row with bounds, which may be a motor with its speed in the
// right-hand side.
double correctionOf(const btSolverConstraint& row, const btSolverBody& a, const btSolverBody& b) {
  if (hasBounds(row) || !(row.m_jacDiagABInv > 0)) return 0;
  return std::abs(static_cast<double>(row.m_rhs / row.m_jacDiagABInv + velocityBefore(row, a, b)));
}

// Returns the difference between the velocity that the row asks for and the one reached [m/s]; 0 if
// the impulse is at a bound.
double missedBy(const btSolverConstraint& row, btSolverBody& a, btSolverBody& b) {
  const btScalar impulse = row.m_appliedImpulse;
  const bool is_bound = impulse <= row.m_lowerLimit || impulse >= row.m_upperLimit;
  if (is_bound || !(row.m_jacDiagABInv > 0)) return 0;
  const btScalar change = row.m_contactNormal1.dot(a.internalGetDeltaLinearVelocity()) +
                          row.m_relpos1CrossNormal.dot(a.internalGetDeltaAngularVelocity()) +
                          row.m_contactNormal2.dot(b.internalGetDeltaLinearVelocity()) +
                          row.m_relpos2CrossNormal.dot(b.internalGetDeltaAngularVelocity());
  return std::abs(
      static_cast<double>((row.m_rhs - impulse * row.m_cfm) / row.m_jacDiagABInv - change));
}

}  // namespace

void JointGaps::watch(const btConstraintArray& joints, RowBodies& ambient,
                      btAlignedObjectArray<btSolverBody>& bodies) noexcept {
  rows_.clear();
  for (int i = 0; i < joints.size(); ++i) {
    const btSolverConstraint& row = joints[i];
    const bool is_shift = !row.m_contactNormal1.isZero() || !row.m_contactNormal2.isZero();
    const int a = row.m_solverBodyIdA, b = row.m_solverBodyIdB;
    if (is_shift && (ambient.find(a) || ambient.find(b)))
      rows_.push_back({i, correctionOf(row, bodies[a], bodies[b])});
  }
}

void JointGaps::measure(const btConstraintArray& joints, RowBodies& ambient,
                        btAlignedObjectArray<btSolverBody>& bodies,
                        double time_step) const noexcept {
  if (ambient.empty()) return;
  AMBIENT_ASSERT(time_step > 0);
  for (const Row& watched : rows_) {
    const btSolverConstraint& row = joints[watched.index];
    const int a = row.m_solverBodyIdA, b = row.m_solverBodyIdB;
    const double gap =
        time_step * std::max(watched.correction, missedBy(row, bodies[a], bodies[b]));
    for (const int id : {a, b}) {
      RowBody* body = ambient.find(id);
      if (body && gap > body->gap) {
        body->gap = gap;
        body->gap_to = id == a ? b : a;
      }
    }
  }
}

AMBIENT_END
