#pragma once

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/members/ambient_trees.h"

AMBIENT_BEGIN

// Links whose wrenches are read. Without such links, one test for each.

/// At the start of a substep, after its links were prepared; `step` has their pose and velocity.
void beginTreeReading(AmbientTree& tree) noexcept;

/// After the action has given the tree its velocity. Changes `step.pose`.
void finishTreeReading(AmbientTree& tree, double duration) noexcept;

AMBIENT_END
