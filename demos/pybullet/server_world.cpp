#include "demos/pybullet/server_world.h"

#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <LinearMath/btIDebugDraw.h>

#include <cstring>
#include <typeinfo>

namespace ambient::pybullet {
namespace {

// Helper that the server has for one call. The server's setGuiHelper() calls
// createPhysicsDebugDrawer() with its world, and no other function.
struct Probe final : SilentHelper {
  btDiscreteDynamicsWorld* world = nullptr;
  void createPhysicsDebugDrawer(btDiscreteDynamicsWorld* its) override { world = its; }
};

// Returns the helper of a server with a window; null: the server has no window. The helper has
// given the world a debug drawer, whose first member is the pointer to the helper.
GuiHelper* helperOf(btIDebugDraw* drawer) {
  if (!drawer || !std::strstr(typeid(*drawer).name(), "MultithreadedDebugDrawer")) return nullptr;
  GuiHelper* helper = nullptr;
  // NOLINTNEXTLINE(bugprone-sizeof-expression): the bytes of a pointer
  std::memcpy(&helper, reinterpret_cast<const char*>(drawer) + sizeof(void*), sizeof helper);
  return helper;
}

}  // namespace

btDiscreteDynamicsWorld* findWorld(Server& server, Client& client) {
  Probe probe;
  server.setGuiHelper(&probe);
  if (!probe.world) {
    server.setGuiHelper(nullptr);
  } else if (GuiHelper* helper = helperOf(probe.world->getDebugDrawer())) {
    server.setGuiHelper(helper);
  } else {
    // Without a window, connect() makes the client give the server PyBullet's own DummyGUIHelper,
    // which lives as long as the server.
    client.connect();
  }
  return probe.world;
}

bool hasOurLayout(btDynamicsWorld& world) {
  const btContactSolverInfo& info = world.getSolverInfo();
  return info.m_maxErrorReduction == 20 && info.m_restitution == 0 &&
         info.m_maxGyroscopicForce == 100;
}

bool hasOurLayout(const btMultiBody& multi_body) {
  int freedoms = 0, positions = 0;
  for (int i = 0; i < multi_body.getNumLinks(); ++i) {
    freedoms += multi_body.getLink(i).m_dofCount;
    positions += multi_body.getLink(i).m_posVarCount;
  }
  return multi_body.getNumDofs() == freedoms && multi_body.getNumPosVars() == positions &&
         multi_body.getUserIndex2() >= 0 && multi_body.getMaxAppliedImpulse() == 1000 &&
         multi_body.getCompanionId() >= -1;
}

}  // namespace ambient::pybullet
