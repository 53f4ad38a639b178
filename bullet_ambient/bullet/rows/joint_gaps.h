#pragma once

#include <BulletDynamics/ConstraintSolver/btSolverBody.h>
#include <BulletDynamics/ConstraintSolver/btSolverConstraint.h>

#include <vector>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/rows/row_rewriting.h"

AMBIENT_BEGIN

/// Part of a body's size by which a joint gapes in a step, and steps in a row in which it does,
/// that say that the solver does not hold it.
constexpr double kWideGap = 0.05;
constexpr int kLongGape = 10;

/// Finds joints that the solver does not hold: rows of ambient bodies against a shift whose
/// velocity is not the one that they ask for, though their impulse is within its bounds, or whose
/// position correction asks for much. A gape is a velocity of either kind times the step [m]. Keeps
/// its memory.
class JointGaps {
 public:
  /// Reads the rows as Bullet has set them up, which tells shifts from turns and has the position
  /// correction in its right side.
  void watch(const btConstraintArray& joints, RowBodies& ambient,
             btAlignedObjectArray<btSolverBody>& bodies) noexcept;
  /// After the iterations: into RowBody::gap, the largest gape of each body.
  void measure(const btConstraintArray& joints, RowBodies& ambient,
               btAlignedObjectArray<btSolverBody>& bodies, double time_step) const noexcept;

 private:
  struct Row {
    int index;          ///< in the pool of joints
    double correction;  ///< velocity that position correction asks for [m/s]
  };
  std::vector<Row> rows_;
};

AMBIENT_END
