#pragma once

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/immersed/ambient_body.h"

AMBIENT_BEGIN

// Contacts that need friction in two directions; docs/theory.md, section 7.

/// Whether a push on the first body of a contact presses it against a face and along it, by more
/// than a hundredth, and no more than friction can hold. `normal_W`: from the second to the first.
bool isHeldAslant(const btVector3& push_W, const btVector3& normal_W, btScalar friction) noexcept;

/// False: no push does what turnsAside() asks.
bool mayTurnAside(const AmbientBody& ambient) noexcept;

/// Whether a push along the normal makes a body slip across it by its fluid.
bool turnsAside(const AmbientBody& ambient, const btVector3& normal_W) noexcept;

AMBIENT_END
