#pragma once

#include <cstdint>

#include "bullet_ambient/fluid_body/fluid_body.h"

namespace ambient {

/// FNV-1a of all that acts on a body's motion: added mass, volume, area, centre of volume,
/// faces, levels and the waterline table. Name, provenance and the surface for drawing do not
/// count. Tells whether saved states belong to a fluid body; detects accidental change, not
/// forgery.
std::uint64_t contentHash(const FluidBody& body);

}  // namespace ambient
