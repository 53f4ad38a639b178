#pragma once

#include <BulletDynamics/ConstraintSolver/btSolverConstraint.h>

#include "bullet_ambient/bullet/core/precision_check.h"

struct btMultiBodyJacobianData;
struct btMultiBodySolverConstraint;

AMBIENT_BEGIN

class AmbientTrees;

/// The rows that Bullet has set up for one group of bodies.
struct RowPools {
  btConstraintArray& contacts;
  btConstraintArray& frictions;
  btConstraintArray& torsional_frictions;
  btConstraintArray& joints;
};

/// The rows between multibodies and what they touch or are joined to.
struct MultiBodyRows {
  btAlignedObjectArray<btMultiBodySolverConstraint>& contacts;
  btAlignedObjectArray<btMultiBodySolverConstraint>& frictions;
  btAlignedObjectArray<btMultiBodySolverConstraint>& rolling_frictions;
  btAlignedObjectArray<btMultiBodySolverConstraint>& spinning_frictions;
  btAlignedObjectArray<btMultiBodySolverConstraint>& joints;
  btMultiBodyJacobianData& data;  ///< Jacobians of the multibodies and their responses
  const AmbientTrees* trees;      ///< whose links may be in a fluid; null: none are
};

AMBIENT_END
