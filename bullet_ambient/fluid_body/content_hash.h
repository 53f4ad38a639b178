#pragma once

#include <cstdint>

#include "bullet_ambient/fluid_body/fluid_body.h"

namespace ambient {

/// FNV-1a hash of all data that influence motion: added mass, volume, area, centre of volume,
/// faces, levels, drag, sphere radius, surface triangles, parts of the added mass and waterline
/// table. Name and provenance do not count. Saved states hold the hash to recognise their fluid
/// body. Detects accidental change, not forgery.
std::uint64_t contentHash(const FluidBody& body);

}  // namespace ambient
