#pragma once

#include <LinearMath/btScalar.h>

#include "bullet_ambient/bullet/precision_check.h"

class btCollisionWorld;
class btIDebugDraw;
struct btContactSolverInfo;

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {

class AmbientBodies;
class AmbientRegistry;
class AmbientTrees;
struct FluidDrawing;

/// The multibodies in fluid that a solver works on, in the order of its calls in one substep. The
/// part of AmbientSolver that gives them the velocities that they have in their fluid, in place of
/// those of Bullet's articulated bodies. Costs one comparison where there are none.
class TreeGroup {
 public:
  explicit TreeGroup(AmbientRegistry& registry);

  /// Before Bullet's own pass: keeps the velocities with which the substep begins.
  void begin() noexcept;
  /// Before the first group is solved: flies all that have not rows that turn with them, and gives
  /// all of them the velocity that rows are solved against.
  void meet(const btContactSolverInfo& info) noexcept;
  /// Whose rows are to be rewritten; null: none.
  const AmbientTrees* met() const noexcept;
  /// After all groups: the velocity that Bullet moves each of them by.
  void finish(const btContactSolverInfo& info) noexcept;

 private:
  void dropStrangers() noexcept;
  void markTurningRows() noexcept;

  AmbientBodies& bodies_;
  bool is_begun_ = false;  // and no group was solved since
};

/// Whether the world has one that is awake and in a fluid.
bool hasAwakeTree(const btCollisionWorld& world, const AmbientBodies& bodies) noexcept;

/// Wakes those that the world has and that follow regions.
void wakeFollowingTrees(const btCollisionWorld& world, const AmbientBodies& bodies) noexcept;

/// As drawFluid() for the links of all trees that the world has.
void drawTrees(const btCollisionWorld& world, const AmbientBodies& bodies, const FluidDrawing& what,
               btIDebugDraw& drawer);

/// After Bullet has moved the bodies of a world: completeTree() for those that the solver has met.
void completeTrees(const btCollisionWorld& world, AmbientBodies& bodies, double time_step) noexcept;

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
