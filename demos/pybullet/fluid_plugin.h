#pragma once

#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "demos/pybullet/command.h"
#include "demos/pybullet/equipment.h"
#include "demos/pybullet/pybullet_interface.h"
#include "demos/pybullet/world_fluid.h"
#include "preprocess/collision_shape/fluid_body_cache.h"

namespace ambient::pybullet {

/// Fluid in the worlds of one PyBullet server, one world after another. Keeps regions and settings
/// when resetSimulation replaces the world.
class FluidPlugin {
 public:
  FluidPlugin(Server& server, Client& client) : server_(server), client_(client) {}

  /// Call before each substep. Connects the fluid with the present world, and adds new bodies.
  void beforeStep();
  /// Takes notice of added and removed bodies and of resetSimulation.
  void notice(const Notification* notifications, int count);
  /// Executes a command. Returns its answer; empty: none. @throws std::exception with one line
  std::string execute(const Arguments& arguments);

 private:
  using Answer = std::string (FluidPlugin::*)(const Command&);
  static const std::map<std::string, Answer> kCommands;  // those of commands.schema.json

  std::string setRegion(const Command& command);
  std::string removeRegion(const Command& command);
  std::string setSettings(const Command& command);
  std::string chooseBody(const Command& command);
  std::string equip(const Command& command);
  std::string drive(const Command& command);
  std::string drives(const Command& command);
  std::string exclude(const Command& command);
  std::string inertia(const Command& command);
  std::string massMatrix(const Command& command);
  std::string wrench(const Command& command);
  std::string wet(const Command& command);
  std::string save(const Command& command);
  std::string restore(const Command& command);
  std::string status(const Command& command);
  std::string leave(const Command& command);

  // Makes the fluid of the present world, or sets refusal_. Does nothing if that was done before.
  void meetWorld();
  void refresh();  // adds new bodies
  void forgetWorld();
  void pushByEquipment();
  FluidBodyCache& shapes();
  // Throws if a body of the world cannot have these settings, with shapes from this folder.
  void checkOnBodies(const FlowSettings& flow, const std::string& folder);
  // Return the fluid of the present world, or throw refusal_; requireCurrent() adds new bodies
  // first.
  WorldFluid& requireFluid();
  WorldFluid& requireCurrent();

  struct Region {
    FluidRegion region;
    RegionId id = RegionId::kNone;  // id in the fluid of the present world
  };

  Server& server_;
  Client& client_;
  std::shared_ptr<FluidBodyCache> shapes_;  // must outlive fluid_
  std::set<std::string> printed_;           // sentences; must outlive fluid_
  std::unique_ptr<WorldFluid> fluid_;
  Equipment equipment_;
  std::vector<Equipment::State> equipment_states_;  // by the number of the saved state
  std::string refusal_;                             // reason why the present world has no fluid
  bool has_news_ = true;  // true: bodies may have been added since they were last put in the fluid
  std::map<std::string, Region> regions_;
  FlowSettings flow_;
  std::string folder_;  // folder of FluidBodyCache; empty: the user's
  std::string pieces_;  // first pieces of a command that is longer than PyBullet's limit
};

}  // namespace ambient::pybullet
