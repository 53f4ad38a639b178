#pragma once

#include <LinearMath/btScalar.h>

#include "bullet_ambient/bullet/core/precision_check.h"

struct btContactSolverInfo;

AMBIENT_BEGIN

class AmbientBodies;
class AmbientTrees;

/// Multibodies in fluid (trees) that a solver works on. Replaces the velocities that Bullet
/// computes for dry multibodies by those in fluid. Functions are declared in the order in which
/// FluidSolver calls them in a substep. Without trees each call costs one comparison.
class TreeGroup {
 public:
  explicit TreeGroup(AmbientBodies& bodies);

  /// Call before Bullet's articulated-body pass. Stores the velocities at the start of the substep,
  /// because that pass overwrites them.
  void begin() noexcept;
  /// Call before the first group is solved; later calls in the substep do nothing. Flies trees on
  /// which only rows of their own joints act. Sets the velocity of each tree to the one that its
  /// rows are solved against, docs/theory.md section 14.
  void prepare(const btContactSolverInfo& info) noexcept;
  /// Returns the trees whose rows have to be rewritten; null: none.
  const AmbientTrees* solvedTrees() const noexcept;
  /// Call after all groups are solved. Sets the velocity that Bullet moves each tree by.
  void finish(const btContactSolverInfo& info) noexcept;

 private:
  /// Detaches trees whose multibody was replaced or has other links than when it was added.
  void detachReplacedTrees() noexcept;
  /// Sets TreeStep::turns_rows of trees with contacts or joints to other bodies.
  void markTurningRows() noexcept;

  AmbientBodies& bodies_;
  bool is_begun_ = false;  // true from begin() until the first group is solved
};

AMBIENT_END
