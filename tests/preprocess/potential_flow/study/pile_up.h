#pragma once

#include "bullet_ambient/force/wetted_inertia.h"

namespace ambient::study {

/// Of docs/theory.md eq. (65): by how much of its draught a touching body raises the water.
constexpr double kPileUp = 0.4;

/// The pose at which an entering body raises the plane to that of `at`, docs/theory.md eq. (65):
/// the runtime's inertia there is that at `at` without the raised plane.
Immersion beforePileUp(const Immersion& at);

}  // namespace ambient::study
