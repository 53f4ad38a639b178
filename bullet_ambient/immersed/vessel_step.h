#pragma once

#include "bullet_ambient/immersed/ambient_body.h"
#include "bullet_ambient/immersed/floating_state.h"
#include "bullet_ambient/immersed/fluid_regions.h"
#include "bullet_ambient/immersed/warnings.h"

namespace ambient {

/// Finds how high a sea with waves stands above its plane at the edges of the openings of a vessel:
/// VesselState::rises. Cost: nothing in still water and for bodies that are small
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
void replaceSurfaceByHold(const HoldAround& around, const AmbientBody& ambient,
                          const MotionView& now, RegionSample& sample) noexcept;

/// Keeps the plane of the surface of a region for this step, and whether waves there are short
/// against the body; decides which holds of one that first meets a surface are full. Allocates
/// nothing. @pre it has holds
void meetSurface(AmbientBody& ambient, const NearSurface& near, const FluidRegion& region) noexcept;

/// Kinetic energy of the water in the holds that swings on its own, beside x.K x / 2 [J].
double sloshingEnergyNow(const AmbientBody& ambient, const MotionView& now);

/// Lets water pass through the openings of a body at a surface at the start of a step of `duration`
/// [s]. Water that comes in was at rest in the water around: sets VesselState::change_B, which the
/// motion of the step adds. Counts, and keeps the body from rest while water flows. Returns true if
/// water has passed. Allocates nothing.
/// @pre it has holds, and a surface is near: meetSurface()
bool exchangeWater(AmbientBody& ambient, const MotionView& now, double duration) noexcept;

/// Lets the water in the holds slosh over a step in which rows move the body, whose twist in B
/// would be x. Returns the twist after that. @pre flotationNow(); water is inside
Vector6 sloshForRows(AmbientBody& ambient, const RigidState& now, double duration,
                     const Vector6& x) noexcept;
/// Lets that water come to the present flotation of the body, after it has moved by rows to a pose
/// B to W with the twist x. `position_W`: relative to the water where the step began. Returns the
/// twist after that, and the inertia of what stands still in B.
Vector6 arriveWithWater(AmbientBody& ambient, const Matrix3& to_world, const Vector3& position_W,
                        bool keeps_momentum, const Vector6& x, SymmetricMatrix& inertia) noexcept;

/// Warns once of a vessel that water has come into one of its holds until that was full, and that
/// the body is then too heavy to float. Apart from that allocates nothing. @pre exchangeWater() has
/// let water pass
void warnOfSunkVessel(AmbientBody& ambient, Warnings& warnings) noexcept;

}  // namespace ambient
