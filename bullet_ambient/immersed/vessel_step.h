#pragma once

#include "bullet_ambient/immersed/ambient_body.h"
#include "bullet_ambient/immersed/complaints.h"
#include "bullet_ambient/immersed/fluid_regions.h"

namespace ambient {

/// Finds how high a sea with waves stands above its plane at the edges of the openings of a vessel:
/// VesselState::rises and has_waves. Cost: nothing in still water and for bodies that are small
/// against the waves, else a call of the surface for each edge of an opening that is no farther
/// from the plane than the body is large. Allocates nothing. @pre the body has holds and is at a
/// surface
void findRimWaves(AmbientBody& ambient, const MotionView& now,
                  const FluidRegions& regions) noexcept;

/// Returns the hold of another body that decides on the water around a body in a region; null:
/// none.
const HoldAround* holdAround(const AmbientBody& ambient, const FluidRegions& regions,
                             const FluidRegions::Entry& entry) noexcept;

/// Puts the level of a hold around a body in the place of the surface of the region. Water and air
/// there move with the vessel; a dry hold has its level far below.
void takeHold(const HoldAround& around, const AmbientBody& ambient, const MotionView& now,
              RegionSample& sample) noexcept;

/// Says once of a vessel that water has come into one of its holds until that was full, and that
/// the body is then too heavy to float. Apart from that allocates nothing. @pre exchangeWater() has
/// let water pass
void saySunk(AmbientBody& ambient, Complaints& complaints) noexcept;

}  // namespace ambient
