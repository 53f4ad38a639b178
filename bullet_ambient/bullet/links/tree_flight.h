#pragma once

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/links/tree_task.h"

AMBIENT_BEGIN

/// Flies a tree that no row turns from `step.pose` with `step.start`; leaves the mean velocity and
/// that of the end. Where the step has come to a place that its energy does not reach, at a water
/// surface, it is flown again in parts, and ends early at last; docs/theory.md eq. (81b). False if
/// a result is not finite. @pre `step.start` has the kicks of the surface
bool flyTree(AmbientTree& tree, const TreeTask& task) noexcept;

/// Whether a tree in fluid flies as a body does: it is free, has no joint, and no row turns with
/// it.
/// @pre prepareLinks()
bool fliesAsBody(const AmbientTree& tree) noexcept;

/// Flies up to kFlightsTogether such trees side by side from `step.pose` with `step.start`, as
/// bodies fly, with the same bits: by their stand-ins. Leaves the mean velocity and that of the
/// end, and writes which of them have flown. A tree has not, and is as before, if its flight is not
/// finite, or if it turns so fast that Bullet would not bring it to the end of the flight.
/// @pre the stand-ins are where the trees are
void flyAsBodies(AmbientTree* const* trees, int count, const TreeTask& task,
                 bool* have_flown) noexcept;

AMBIENT_END
