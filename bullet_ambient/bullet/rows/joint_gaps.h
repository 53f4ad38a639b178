#pragma once

#include <BulletDynamics/ConstraintSolver/btSolverBody.h>
#include <BulletDynamics/ConstraintSolver/btSolverConstraint.h>

#include <vector>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/rows/row_rewriting.h"

AMBIENT_BEGIN

/// Part of a body's size by which a joint misses in a step, and steps in a row in which it does,
/// that say that the iterations do not hold it.
constexpr double kWideGap = 0.05;
constexpr int kLongGape = 10;

/// Finds joints that the iterations do not hold: rows of ambient bodies against a shift whose
/// velocity is not the one that they ask for, though their impulse is within its bounds. Keeps its
/// memory.
class JointGaps {
 public:
  /// Reads the rows as Bullet has set them up, which tells shifts from turns.
  void watch(const btConstraintArray& joints, RowBodies& ambient) noexcept;
  /// After the iterations: into RowBody::gap, the largest of each body.
  void measure(const btConstraintArray& joints, RowBodies& ambient,
               btAlignedObjectArray<btSolverBody>& bodies, double time_step) const noexcept;

 private:
  std::vector<int> rows_;
};

AMBIENT_END
