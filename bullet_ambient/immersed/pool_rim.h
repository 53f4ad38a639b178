#pragma once

#include "bullet_ambient/immersed/ambient_body.h"
#include "bullet_ambient/immersed/fluid_regions.h"

namespace ambient {

// A body across the rim of a pool: the bounds of a region of water cut it, and no water is beyond.

/// Finds the region of a body in a step of `duration` [s]: that at its centre of mass, or, where
/// that has no surface, a pool into whose water it reaches from outside. Adds the number of tests
/// to `asked`. Cost: RegionIndex::findAround(), and that of findSides() where bounds are near.
RegionsAround findRegions(const AmbientBody& ambient, const MotionView& now,
                          const FluidRegions& regions, double duration, long long& asked) noexcept;

/// Returns the point at which a region is sampled for a body: its centre of mass, or the point of
/// the region that is nearest to it.
Vector3 pointIn(const FluidRegion& region, const Vector3& centre_W) noexcept;

/// Returns the sides of a region of water beyond which a body reaches where its velocity brings it
/// in a time `ahead` [s], but those with water beyond. Balls have none: their centre decides.
PoolSides findSides(const AmbientBody& ambient, const MotionView& now, const FluidRegions& regions,
                    const RegionEntry& pool, double ahead) noexcept;

/// Computes by how much the water presses a body across the sides of its pool, and resists where
/// more of it comes into the water in a step of `duration` [s]: FlowAlongBody::side_push_W,
/// growth_W.
/// @pre it is at a surface
void findSidePush(AmbientBody& ambient, const MotionView& now, double duration) noexcept;

}  // namespace ambient
