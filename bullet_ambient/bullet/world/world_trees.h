#pragma once

#include "bullet_ambient/bullet/core/precision_check.h"

class btCollisionWorld;
class btIDebugDraw;

AMBIENT_BEGIN

class AmbientBodies;
struct FluidDrawing;

/// True if the world has a multibody that is awake and in a fluid.
bool hasAwakeTree(const btCollisionWorld& world, const AmbientBodies& bodies) noexcept;

/// Wakes the sleeping multibodies of the world of which a link in fluid has another mass than
/// before.
void wakeReloadedTrees(const btCollisionWorld& world, const AmbientBodies& bodies) noexcept;

/// Wakes the multibodies of the world that follow regions.
void wakeFollowingTrees(const btCollisionWorld& world, const AmbientBodies& bodies) noexcept;

/// Calls drawFluid() for the links of all trees that the world has.
void drawTrees(const btCollisionWorld& world, const AmbientBodies& bodies, const FluidDrawing& what,
               btIDebugDraw& drawer);

/// After Bullet has moved the bodies of a world: completeTree() for those that the solver has met.
void completeTrees(const btCollisionWorld& world, AmbientBodies& bodies, double time_step) noexcept;

AMBIENT_END
