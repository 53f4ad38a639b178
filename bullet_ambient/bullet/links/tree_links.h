#pragma once

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/links/tree_task.h"

AMBIENT_BEGIN

/// Brings links, their fluids and forces up to date at the start of a substep, and the stand-ins of
/// a tree without joints to where it is. False if no link is in a fluid. Allocates nothing.
bool prepareLinks(AmbientTree& tree, const TreeTask& task) noexcept;

/// The flow from which the motion of a tree is seen: that of its links, if it is one and the base
/// may follow it; otherwise none.
Vector3 flowAround(const LinkTree& tree) noexcept;

/// Brings the stand-ins to where the links are at `step.pose`, moving by u.
void placeStandIns(AmbientTree& tree, const CoordinatesIn& u) noexcept;

/// Between two steps: brings the stand-ins to where the links are and move now.
void moveStandIns(AmbientTree& tree) noexcept;

/// Adds what was computed of a tree to the counters of its links.
void addCount(const FlightCount& count, AmbientTree& tree) noexcept;

/// Adds energy that a bound has taken from the motion of a tree [J].
void countEnergyRemoved(double energy, AmbientTree& tree) noexcept;

/// Does for a tree what keepAwakeWhileMoving() and keepAwakeInUnsteadyFluid() do for a body.
void keepTreeAwake(AmbientTree& tree) noexcept;

AMBIENT_END
