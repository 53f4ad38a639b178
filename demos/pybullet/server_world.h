#pragma once

#include "demos/pybullet/pybullet_interface.h"

class btDynamicsWorld;
class btMultiBody;

namespace ambient::pybullet {

/// Returns the world of a server; null: it has none. Gives the server another helper for the time
/// of the call, and then its own again. Takes less than 16 us. `client`: Context::client.
btDiscreteDynamicsWorld* findWorld(Server& server, Client& client);

/// True if the members of PyBullet's class are where the plugin's Bullet has them. PyBullet builds
/// with the same API number differ: btMultiBody has other members before 3.1.7, and Bullet may be
/// built in single precision. Compares members that PyBullet never changes with their known values,
/// and counts of freedoms with their sums.
bool hasOurLayout(btDynamicsWorld& world);
bool hasOurLayout(const btMultiBody& multi_body);

}  // namespace ambient::pybullet
