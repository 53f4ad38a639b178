#pragma once

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/links/tree_task.h"

AMBIENT_BEGIN

/// Flies a tree that no row turns from `step.pose` with `step.start`; leaves the mean velocity and
/// that of the end. Where the step has come to a place that its energy does not reach, at a water
/// surface, it is flown again in parts, and ends early at last; docs/theory.md eq. (81b). False if
/// a result is not finite. @pre `step.start` has the kicks of the surface
bool flyTree(AmbientTree& tree, const TreeTask& task) noexcept;

AMBIENT_END
