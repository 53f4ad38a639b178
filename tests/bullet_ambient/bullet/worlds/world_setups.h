#pragma once

#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "bullet_ambient/fluid.h"
#include "tests/support/world.h"

namespace ambient::test {

/// World set up like a user's program: with Bullet's solver, or with ambient solver and action.
/// A broadphase whose pairs do not depend on the motion of all bodies, as btDbvtBroadphase drops
/// them: Bullet merges islands by pairs.
class WorldHost : protected WorldParts<btSimpleBroadphase> {
 public:
  WorldHost() = default;
  WorldHost(const WorldHost&) = delete;
  WorldHost& operator=(const WorldHost&) = delete;
  virtual ~WorldHost() = default;

  virtual btDiscreteDynamicsWorld& world() = 0;
  /// Returns null if the world does not support soft bodies.
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

  /// @pre the host is ambient
  Fluid& fluid() { return *fluid_; }

 protected:
  std::optional<Fluid> fluid_;  // of the world of a derived class, which resets it first
};

/// A supported combination of world and solver. One source makes all of them, because each one is a
/// template.
struct WorldSetup {
  const char* name;
  std::unique_ptr<WorldHost> (*make)(bool is_ambient);
};
inline void PrintTo(const WorldSetup& setup, std::ostream* out) { *out << setup.name; }

const std::vector<WorldSetup>& allWorlds();
inline std::string nameOf(const testing::TestParamInfo<WorldSetup>& test) {
  return test.param.name;
}
/// Tells if the setup's name contains the solver's name.
inline bool usesSolver(const WorldSetup& setup, const char* solver) {
  return std::strstr(setup.name, solver) != nullptr;
}
/// @pre a setup has this name
const WorldSetup& worldNamed(const std::string& name);

}  // namespace ambient::test
