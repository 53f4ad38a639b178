#pragma once

#include "bullet_ambient/bullet/precision_check.h"
#include "bullet_ambient/bullet/tree_motion.h"

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {

/// Brings links, their fluids and forces up to date at the start of a substep. False if no link is
/// in a fluid. Allocates nothing.
bool prepareLinks(AmbientTree& tree, const TreeTask& task) noexcept;

/// The flow from which the motion of a tree is seen: that of its links, if it is one and the base
/// may follow it; otherwise none.
Vector3 flowAround(const LinkTree& tree) noexcept;

/// Between two steps: brings the stand-ins to where the links are and move now.
void moveStandIns(AmbientTree& tree) noexcept;

/// Adds what was computed of a tree to the counters of its links.
void addCount(const FlightCount& count, AmbientTree& tree) noexcept;

/// Adds energy that a bound has taken from the motion of a tree [J].
void countEnergyRemoved(double energy, AmbientTree& tree) noexcept;

/// As keepAwakeWhileMoving() and keepAwakeInUnsteadyFluid() of a body.
void keepTreeAwake(AmbientTree& tree) noexcept;

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
