#pragma once

#include <LinearMath/btScalar.h>

#include "bullet_ambient/bullet/core/precision_check.h"

struct btContactSolverInfo;

AMBIENT_BEGIN

class AmbientBodies;
class AmbientTrees;

/// The multibodies in fluid that a solver works on, in the order of its calls in one substep. The
/// part of FluidSolver that gives them the velocities that they have in their fluid, in place of
/// those of Bullet's articulated bodies. Costs one comparison where there are none.
class TreeGroup {
 public:
  explicit TreeGroup(AmbientBodies& bodies);

  /// Before Bullet's own pass: keeps the velocities with which the substep begins.
  void begin() noexcept;
  /// Before the first group is solved: flies all that have not rows that turn with them, and gives
  /// all of them the velocity that rows are solved against.
  void meet(const btContactSolverInfo& info) noexcept;
  /// Returns the trees whose rows are to be rewritten; null: none.
  const AmbientTrees* met() const noexcept;
  /// After all groups: the velocity that Bullet moves each of them by.
  void finish(const btContactSolverInfo& info) noexcept;

 private:
  /// Detaches trees whose multibody was replaced or has other links than when it was added.
  void detachReplacedTrees() noexcept;
  void markTurningRows() noexcept;

  AmbientBodies& bodies_;
  bool is_begun_ = false;  // and no group was solved since
};

AMBIENT_END
