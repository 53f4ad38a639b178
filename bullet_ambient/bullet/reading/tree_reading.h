#pragma once

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/members/ambient_trees.h"

AMBIENT_BEGIN

// Functions for links whose wrenches are read. Cost without such links: one test per link.

/// Begins a substep, after the links were prepared and AmbientTree::step has pose and velocity.
void beginTreeReading(AmbientTree& tree) noexcept;

/// Computes the wrenches after the action has set the velocity of the tree; duration [s]. Changes
/// AmbientTree::step.pose.
void finishTreeReading(AmbientTree& tree, double duration) noexcept;

AMBIENT_END
