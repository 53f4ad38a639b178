#pragma once

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/links/tree_links.h"
#include "bullet_ambient/bullet/members/ambient_trees.h"

AMBIENT_BEGIN

// Functions for links whose wrenches are read. Cost without such links: one test per link.

/// Begins a substep, after the links were prepared and AmbientTree::step has pose and velocity.
void beginTreeReading(AmbientTree& tree) noexcept;

/// Computes the wrenches after the action has set the velocity of the tree; duration [s]. Changes
/// AmbientTree::step.pose.
void finishTreeReading(AmbientTree& tree, double duration) noexcept;

/// Replaces the joint forces in each btMultiBodyJointFeedback of the links, which Bullet has
/// computed without fluid, by those in fluid: inverse dynamics of the mean acceleration of the
/// substep, at the pose in its middle. Forces of rows count as applied forces, as in Bullet.
/// Velocity-dependent terms count once; Bullet counts them twice. @pre `step` has the velocities of
/// this substep
void writeJointForces(AmbientTree& tree, const TreeTask& task) noexcept;

AMBIENT_END
