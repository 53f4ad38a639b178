#pragma once

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/immersed/ambient_body.h"

AMBIENT_BEGIN

// Finds contacts that need two friction rows; docs/theory.md, section 7, "Friction".

/// True if a push on the first body of a contact presses the bodies together, and its part along
/// the face, relative to the part along the normal, is between 0.01 and the coefficient of
/// friction. `normal_W`: from the second body to the first.
bool isHeldAslant(const btVector3& push_W, const btVector3& normal_W, btScalar friction) noexcept;

/// False: turnsAside() is false for every normal.
bool mayTurnAside(const AmbientBody& ambient) noexcept;

/// True if a push along the normal also moves the body across the normal, by more than 10^-3 of its
/// motion, because of added mass.
bool turnsAside(const AmbientBody& ambient, const btVector3& normal_W) noexcept;

AMBIENT_END
