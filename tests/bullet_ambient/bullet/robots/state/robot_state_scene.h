#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "bullet_ambient/saved_state.h"
#include "tests/bullet_ambient/bullet/robots/robot_world.h"
#include "tests/bullet_ambient/bullet/state/state_scene.h"

namespace ambient::test {

enum class RobotStateKind {
  kFlight,    ///< all kinds of joints, free and fixed bases, one without fluid
  kMotors,    ///< motors, limits and gears, warm started
  kContacts,  ///< robots with friction on a floor, one without fluid
  kTethers,   ///< tips on ball joints to the world
  kWater,     ///< chains that dive and come up in waves
  kSwimming,  ///< a chain that water slows down
};

constexpr RobotStateKind kRobotStateKinds[] = {
    RobotStateKind::kFlight,  RobotStateKind::kMotors, RobotStateKind::kContacts,
    RobotStateKind::kTethers, RobotStateKind::kWater,  RobotStateKind::kSwimming};

/// Robots for saving and restoring. Each instance is built in the same way.
class RobotStateScene {
 public:
  explicit RobotStateScene(RobotStateKind kind);

  void step(int count = 1) { robots_.step(1 / 120.0, count); }
  WorldState save() const { return fluid().save(); }
  void restore(const WorldState& state) { fluid().restore(state); }
  FluidBodyLookup lookup() const;
  std::string motion() const { return motionBytes(fluid()); }
  SavedRun saved() {
    return {fluid(), [this] { step(); }};
  }
  std::vector<std::string> record(int steps) { return test::record(saved(), steps); }

  Fluid& fluid() const { return robots_.fluid; }
  btMultiBodyDynamicsWorld& world() { return robots_.world; }
  btMultiBody& robot(int i) { return *robots_.world.getMultiBody(i); }

 private:
  btMultiBody& add(const RobotDef& def);
  btMultiBody& addInFluid(const RobotDef& def);
  void attach(btMultiBody& body, int link, AttachDef def);
  void addFlight();
  void addMotors();
  void addContacts();
  void addTethers();
  void addWater();
  void addSwimmer();

  Arbitrary arbitrary_{11};
  std::map<std::string, std::shared_ptr<const FluidBody>> shapes_;
  mutable RobotWorld robots_;
};

}  // namespace ambient::test
