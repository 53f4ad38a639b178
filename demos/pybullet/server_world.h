#pragma once

#include "demos/pybullet/pybullet_interface.h"

class btDynamicsWorld;
class btMultiBody;

namespace ambient::pybullet {

/// Asks a server for its world, and leaves the server as it was; null: its world is gone. Takes
/// less than 16 us. `client`: the one of the plugin manager, Context::client.
btDiscreteDynamicsWorld* findWorld(Server& server, Client& client);

/// Whether members lie where ours do. PyBullets of one API number differ: btMultiBody has grown
/// before 3.1.7, and one may be built in float. Numbers that PyBullet never changes, and sums that
/// always hold, show it.
bool hasOurLayout(btDynamicsWorld& world);
bool hasOurLayout(const btMultiBody& multi_body);

}  // namespace ambient::pybullet
