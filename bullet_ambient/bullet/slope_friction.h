#pragma once

#include "bullet_ambient/bullet/ambient_body.h"
#include "bullet_ambient/bullet/precision_check.h"

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {

// Where a contact needs friction both ways; docs/theory.md, section 7.

/// Whether a push on the first body of a contact presses it against a face and along it, by more
/// than a hundredth, and no more than friction can hold. `normal_W`: from the second to the first.
bool isHeldAslant(const btVector3& push_W, const btVector3& normal_W, btScalar friction) noexcept;

/// False: no push does what turnsAside() asks.
bool mayTurnAside(const AmbientBody& ambient) noexcept;

/// Whether a push along the normal makes a body slip across it by its fluid.
bool turnsAside(const AmbientBody& ambient, const btVector3& normal_W) noexcept;

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
