#pragma once

#include "demos/pybullet/pybullet_interface.h"

namespace ambient::pybullet {

/// Helper that shows nothing, like PyBullet's own one without a window.
struct SilentHelper : GuiHelper {
  void createRigidBodyGraphicsObject(void*, const void*) override {}
  void createCollisionObjectGraphicsObject(void*, const void*) override {}
  void createCollisionShapeGraphicsObject(void*) override {}
  void syncPhysicsToGraphics(const void*) override {}
  void syncPhysicsToGraphics2(const void*) override {}
  void syncPhysicsToGraphics2(const void*, int) override {}
  void render(const void*) override {}
  void createPhysicsDebugDrawer(btDiscreteDynamicsWorld*) override {}
};

}  // namespace ambient::pybullet
