#include "bullet_ambient/bullet/rows/joint_gaps.h"

#include <cmath>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/bullet/members/ambient_bodies.h"

AMBIENT_BEGIN
namespace {

// Velocity along the row that it asks for and has not got [m/s]; 0 at a bound.
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

void JointGaps::watch(const btConstraintArray& joints, RowBodies& ambient) noexcept {
  rows_.clear();
  for (int i = 0; i < joints.size(); ++i) {
    const btSolverConstraint& row = joints[i];
    const bool is_shift = !row.m_contactNormal1.isZero() || !row.m_contactNormal2.isZero();
    if (is_shift && (ambient.find(row.m_solverBodyIdA) || ambient.find(row.m_solverBodyIdB)))
      rows_.push_back(i);
  }
}

void JointGaps::measure(const btConstraintArray& joints, RowBodies& ambient,
                        btAlignedObjectArray<btSolverBody>& bodies,
                        double time_step) const noexcept {
  if (ambient.empty()) return;
  AMBIENT_ASSERT(time_step > 0);
  for (const int i : rows_) {
    const btSolverConstraint& row = joints[i];
    const int a = row.m_solverBodyIdA, b = row.m_solverBodyIdB;
    const double gap = time_step * missedBy(row, bodies[a], bodies[b]);
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
