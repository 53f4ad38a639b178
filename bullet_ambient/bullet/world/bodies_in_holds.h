#pragma once

#include "bullet_ambient/bullet/members/ambient_bodies.h"

class btCollisionWorld;

AMBIENT_BEGIN

/// Finds which bodies and links of a world have their centre of mass in a hold of a vessel at a
/// surface of water, and the level there with what they displace: AmbientBody::in_hold of these,
/// and HoldState::displaced of the vessels, for the next substep. A body is in no hold that it is
/// larger than, and in the smallest vessel of several. Wakes what floats in a vessel that is awake.
/// Cost: 10 ns a body where none is smaller than the largest hold at a surface. Else a look at each
/// in the world, and the poses of links; the order from west to east of the smaller ones and of
/// vessels; for a body near a vessel the triangles of its holds; for a hold with bodies and water
/// some clips of all of them. Allocates nothing but for bodies that are new.
void findBodiesInHolds(btCollisionWorld& world, AmbientBodies& bodies) noexcept;

AMBIENT_END
