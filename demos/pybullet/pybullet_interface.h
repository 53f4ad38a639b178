#pragma once

class btDiscreteDynamicsWorld;

/// Declarations of Bullet's examples/SharedMemory that a plugin needs, with the same layouts:
/// Debian does not package these headers. Equal from Bullet 3.06 to its master of 2025-01.
namespace ambient::pybullet {

constexpr int kApiVersion = 202010061;  // SHARED_MEMORY_MAGIC_NUMBER

struct Arguments {  // b3PluginArguments
  char text[1024];
  int int_count;
  int ints[128];
  int float_count;
  double floats[128];
};

struct ReturnData {  // b3UserDataValue
  int type;          // 2: text
  int length;
  const char* bytes;
};

enum NotificationType { kSimulationReset = 0, kBodyAdded = 1, kBodyRemoved = 2 };

struct Notification {  // b3Notification
  int type;
  union {
    int body;
    double alignment_and_size[34];
  };
};

// First virtual functions of GUIHelperInterface, in its order, which has been the same since 2.89.
// Later functions have changed places: 3.22 has inserted addUserDebugPoints under the same API
// number. So the server must never call other functions of a helper that the plugin gives to it.
struct GuiHelper {
  virtual ~GuiHelper() = default;
  virtual void createRigidBodyGraphicsObject(void*, const void*) = 0;
  virtual void createCollisionObjectGraphicsObject(void*, const void*) = 0;
  virtual void createCollisionShapeGraphicsObject(void*) = 0;
  virtual void syncPhysicsToGraphics(const void*) = 0;
  virtual void syncPhysicsToGraphics2(const void*) = 0;
  virtual void syncPhysicsToGraphics2(const void*, int) = 0;
  virtual void render(const void*) = 0;
  virtual void createPhysicsDebugDrawer(btDiscreteDynamicsWorld* world) = 0;
};

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

// First virtual functions of PhysicsCommandProcessorInterface.
struct Server {
  virtual ~Server() = default;
  virtual bool connect() = 0;
  virtual void disconnect() = 0;
  virtual bool isConnected() const = 0;
  virtual bool processCommand(const void*, void*, char*, int) = 0;
  virtual bool receiveStatus(void*, char*, int) = 0;
  virtual void renderScene(int) = 0;
  virtual void physicsDebugDraw(int) = 0;
  virtual void setGuiHelper(GuiHelper* helper) = 0;
};

// First virtual functions of PhysicsClient.
struct Client {
  virtual ~Client() = default;
  virtual bool connect() = 0;
};

struct Context {  // b3PluginContext
  Client* client;
  void* user_pointer;
  ReturnData* return_data;
  const void* vr_events;
  int vr_event_count;
  const void* key_events;
  int key_event_count;
  const void* mouse_events;
  int mouse_event_count;
  const Notification* notifications;
  int notification_count;
  Server* server;  // set in initPlugin and executePluginCommand only
};

}  // namespace ambient::pybullet
