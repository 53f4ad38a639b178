#pragma once

#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>
#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "bullet_ambient/bullet/ambient_action.h"

namespace ambient::test {

/// A world as a program sets it up: with Bullet's own solver, or with an ambient solver and action.
class WorldHost {
 public:
  WorldHost() = default;
  WorldHost(const WorldHost&) = delete;
  WorldHost& operator=(const WorldHost&) = delete;
  virtual ~WorldHost() = default;

  virtual btDiscreteDynamicsWorld& world() = 0;
  /// Null if the world does not take such bodies.
  btSoftRigidDynamicsWorld* softWorld() {
    return dynamic_cast<btSoftRigidDynamicsWorld*>(&world());
  }
  btMultiBodyDynamicsWorld* multiBodyWorld() {
    return dynamic_cast<btMultiBodyDynamicsWorld*>(&world());
  }
  void step(double duration, int count = 1) {
    const auto dt = static_cast<btScalar>(duration);
    for (int i = 0; i < count; ++i) world().stepSimulation(dt, 0, dt);
  }

  AmbientRegistry registry;  ///< without bodies where the solver is Bullet's own

 protected:
  btSoftBodyRigidBodyCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  // Not btDbvtBroadphase: when it drops pairs that are apart again depends on how everything else
  // moves, and Bullet merges islands by pairs.
  btSimpleBroadphase broadphase_;
  AmbientAction action_{registry};
};

/// A world and a solver that a program may combine. All are made in one source, because each is a
/// template of its own.
struct WorldSetup {
  const char* name;
  std::unique_ptr<WorldHost> (*make)(bool is_ambient);
};
inline void PrintTo(const WorldSetup& setup, std::ostream* out) { *out << setup.name; }

const std::vector<WorldSetup>& allWorlds();
inline std::string nameOf(const testing::TestParamInfo<WorldSetup>& test) {
  return test.param.name;
}
/// Whether the solver's name is part of that of the setup.
inline bool usesSolver(const WorldSetup& setup, const char* solver) {
  return std::strstr(setup.name, solver) != nullptr;
}
/// @pre there is one of that name.
const WorldSetup& worldNamed(const std::string& name);

}  // namespace ambient::test
