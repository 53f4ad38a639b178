#pragma once

#include <BulletDynamics/ConstraintSolver/btSolverConstraint.h>

#include "bullet_ambient/bullet/core/precision_check.h"

struct btMultiBodyJacobianData;
struct btMultiBodySolverConstraint;

AMBIENT_BEGIN

class AmbientTrees;

/// Rows that Bullet has set up for one group of bodies.
struct RowPools {
  btConstraintArray& contacts;
  btConstraintArray& frictions;
  btConstraintArray& torsional_frictions;
  btConstraintArray& joints;
};

/// Rows of multibodies: their contacts, and joints among them or to rigid bodies.
struct MultiBodyRows {
  btAlignedObjectArray<btMultiBodySolverConstraint>& contacts;
  btAlignedObjectArray<btMultiBodySolverConstraint>& frictions;
  btAlignedObjectArray<btMultiBodySolverConstraint>& rolling_frictions;
  btAlignedObjectArray<btMultiBodySolverConstraint>& spinning_frictions;
  btAlignedObjectArray<btMultiBodySolverConstraint>& joints;
  btMultiBodyJacobianData& data;  ///< Jacobians of the multibodies and their responses
  const AmbientTrees* trees;      ///< multibodies in fluid; null: none
};

AMBIENT_END
