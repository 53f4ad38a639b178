#pragma once

#include <memory>

#include "bullet_ambient/force/surface/wetted_inertia.h"

namespace ambient {

/// Makes the added mass of a body at the surface of the water. Sphere: WettedSphere. With parts of
/// the added mass: WettedParts, eq. (60), or WettedTable, eq. (61a). Without parts: the added mass
/// times the wet share of the volume. Cost: O(parts).
std::shared_ptr<const WettedInertia> makeWettedInertia(
    const std::shared_ptr<const FluidBody>& body);

}  // namespace ambient
