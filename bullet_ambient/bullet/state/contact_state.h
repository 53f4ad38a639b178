#pragma once

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/state/world_state_structs.h"

class btCollisionWorld;

AMBIENT_BEGIN

/// Overlapping pairs in the order in which Bullet keeps them.
std::vector<PairState> savePairs(btCollisionWorld& world);

/// Contact points in the order in which Bullet keeps them.
std::vector<ContactState> saveContacts(btCollisionWorld& world);

/// Adds the saved pairs to those that overlap, lets its collision detection make the places for
/// their contact points, and fills in the saved points; both in the saved order. All other places
/// become empty. @pre the bodies are where they were. Leaves dynamic ones
/// awake.
void restoreContacts(const std::vector<PairState>& pairs, const std::vector<ContactState>& contacts,
                     btCollisionWorld& world);

AMBIENT_END
