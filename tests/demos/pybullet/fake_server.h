#pragma once

#include <BulletCollision/btBulletCollisionCommon.h>
#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>

#include <memory>
#include <string>
#include <vector>

#include "demos/pybullet/pybullet_interface.h"

namespace ambient::pybullet::test {

/// PyBullet's server, its plugin manager and that one's client, towards one plugin: PyBullet's
/// calls in PyBullet's order. Numbers in the source are lines of examples/SharedMemory of 3.24,
/// PhysicsServerCommandProcessor.cpp where no file is named.
class FakeServer : public Server, public Client {
 public:
  FakeServer();
  /// The world first, the plugin last.
  ~FakeServer() override;
  FakeServer(const FakeServer&) = delete;
  FakeServer& operator=(const FakeServer&) = delete;

  /// p.loadPlugin(path, "_ambient"); false: refused
  bool load(const char* path);
  /// p.unloadPlugin()
  void unload();
  /// p.executePluginCommand(): the result, a space and the answer
  std::string command(const std::string& text);
  /// p.resetSimulation(); `in_one_round`: other clients' commands run before notifications come
  void reset(bool in_one_round = false);
  /// p.setPhysicsEngineParameter(constraintSolverType=)
  void changeSolver(bool has_mlcp);
  /// p.createMultiBody() of a cube, or of a tray of five boxes, 1 x 0.6 x 0.4 m; its number
  int add(double half_width, double mass);
  int addTray(double mass);
  /// p.removeBody()
  void remove(int number);
  void step(int count);
  double height(int number) const;
  /// Whether a new cube of half the density of water rises.
  bool floats();
  bool hasItsHelper() const { return helper_ == &dummy_; }
  btMultiBody& body(int number) { return *bodies_[static_cast<std::size_t>(number)]; }
  btMultiBodyDynamicsWorld& world() { return *world_; }

  bool connect() override;
  void disconnect() override {}
  bool isConnected() const override { return true; }
  bool processCommand(const void*, void*, char*, int) override { return false; }
  bool receiveStatus(void*, char*, int) override { return false; }
  void renderScene(int) override {}
  void physicsDebugDraw(int) override {}
  void setGuiHelper(GuiHelper* helper) override;

 private:
  static void preTick(btDynamicsWorld* world, btScalar);
  Context makeContext();
  void createWorld();
  void deleteWorld();
  int add(btCompoundShape* compound, double mass);
  void destroy(btMultiBody*& body);
  void notify(NotificationType type, int body);
  void report();
  template <class Function>
  Function* symbol(const char* name) const;

  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btMultiBodyConstraintSolver* solver_ = nullptr;
  std::unique_ptr<btMultiBodyDynamicsWorld> world_;
  std::vector<btMultiBody*> bodies_;
  SilentHelper dummy_;
  GuiHelper* helper_ = &dummy_;
  void* plugin_ = nullptr;
  void* user_pointer_ = nullptr;
  std::vector<Notification> notifications_;
};

}  // namespace ambient::pybullet::test
