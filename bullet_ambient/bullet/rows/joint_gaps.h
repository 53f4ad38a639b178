#pragma once

#include <BulletDynamics/ConstraintSolver/btSolverBody.h>
#include <BulletDynamics/ConstraintSolver/btSolverConstraint.h>
#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>

#include <vector>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/rows/row_rewriting.h"

AMBIENT_BEGIN

/// Returns the joint of a row in the pool of joint rows.
inline const btTypedConstraint* jointOf(const btSolverConstraint& row) {
  return static_cast<const btTypedConstraint*>(row.m_originalContactPoint);
}

/// True if the impulse of a joint row has other bounds than the joint's breaking impulse: the row
/// is a limit, a motor or a spring.
inline bool hasBounds(const btSolverConstraint& row) {
  const btScalar most = jointOf(row)->getBreakingImpulseThreshold();
  return row.m_lowerLimit > -most || row.m_upperLimit < most;
}

/// Gap of a joint per step, relative to the size of its body, that is reported after kLongGape
/// steps in a row.
constexpr double kWideGap = 0.05;
constexpr int kLongGape = 10;

/// Finds joints that the solver does not hold. The gap of a joint row against translation is the
/// step times the larger of two velocities [m]: the difference between the velocity that the row
/// asks for and the one that the iterations have reached (0 if the impulse is at a bound), and the
/// velocity of position correction. Reuses its memory.
class JointGaps {
 public:
  /// Stores the rows of ambient bodies against translation, and their position corrections. Call
  /// before rows are rewritten: later, Jacobians and right-hand sides no longer tell these.
  void watch(const btConstraintArray& joints, RowBodies& ambient,
             btAlignedObjectArray<btSolverBody>& bodies) noexcept;
  /// Writes the largest gap of each ambient body to RowBody::gap. Call after the iterations;
  /// `time_step` [s].
  void measure(const btConstraintArray& joints, RowBodies& ambient,
               btAlignedObjectArray<btSolverBody>& bodies, double time_step) const noexcept;

 private:
  struct Row {
    int index;          ///< index in the pool of joint rows
    double correction;  ///< velocity of position correction [m/s]
  };
  std::vector<Row> rows_;
};

AMBIENT_END
