#pragma once

#include "bullet_ambient/immersed/ambient_body.h"
#include "bullet_ambient/immersed/fluid_regions.h"

namespace ambient {

/// Finds how high a sea with waves stands above its plane at the edges of the openings of a vessel:
/// VesselState::rises and has_waves. Cost: nothing in still water and for bodies that are small
/// against the waves, else a call of the surface for each edge of an opening that is no farther
/// from the plane than the body is large. Allocates nothing. @pre the body has holds and is at a
/// surface
void findRimWaves(AmbientBody& ambient, const MotionView& now,
                  const FluidRegions& regions) noexcept;

}  // namespace ambient
