#pragma once

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/members/ambient_trees.h"
#include "bullet_ambient/immersed/ambient_body.h"

AMBIENT_BEGIN

/// Response of the velocity of a rigid body to a wrench impulse at its centre of mass, world axes:
/// K^-1, or K_eff^-1 of docs/theory.md eq. (30) with locked axes. K as it is with the mass of now.
/// @throws std::invalid_argument as makeBodyModel().
Matrix6 inverseInertia(AmbientBody& ambient);

/// Adds to the velocity of a body what such an impulse changes of it; a body that no fluid acts on
/// answers by its dry mass. @throws as inverseInertia().
void applyImpulseToBody(AmbientBody& ambient, const Wrench& impulse);

/// Adds to the velocities of a tree what an impulse at the centre of mass of one of its links
/// changes of them, H^-1 J^T impulse; world axes. @throws as inverseInertia().
void applyImpulseToLink(const AmbientTrees& trees, const AmbientTree& tree, int link,
                        const Wrench& impulse);

AMBIENT_END
