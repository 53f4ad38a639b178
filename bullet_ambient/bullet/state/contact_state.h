#pragma once

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/state/world_state_structs.h"

class btCollisionWorld;

AMBIENT_BEGIN

/// Saves the overlapping pairs in Bullet's order.
std::vector<PairState> savePairs(btCollisionWorld& world);

/// Saves the contact points in Bullet's order.
std::vector<ContactState> saveContacts(btCollisionWorld& world);

/// Restores pairs and contact points, both in the saved order: adds the saved pairs to the
/// overlapping ones, runs the world's collision detection to make manifolds, and fills in the saved
/// points. All other manifolds become empty. Leaves dynamic bodies awake. @pre the bodies have
/// their saved poses
void restoreContacts(const std::vector<PairState>& pairs, const std::vector<ContactState>& contacts,
                     btCollisionWorld& world);

AMBIENT_END
