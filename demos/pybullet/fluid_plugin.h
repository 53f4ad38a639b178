#pragma once

#include <map>
#include <memory>
#include <string>

#include "demos/pybullet/command.h"
#include "demos/pybullet/pybullet_interface.h"
#include "demos/pybullet/world_fluid.h"
#include "preprocess/collision_shape/fluid_body_cache.h"

namespace ambient::pybullet {

/// A fluid in the worlds of one PyBullet server. Regions and settings survive resetSimulation.
class FluidPlugin {
 public:
  FluidPlugin(Server& server, Client& client) : server_(server), client_(client) {}

  /// Before each substep.
  void beforeStep();
  void notice(const Notification* notifications, int count);
  /// Its answer; empty: nothing to say. @throws std::exception with one line
  std::string execute(const Arguments& arguments);

 private:
  using Answer = std::string (FluidPlugin::*)(Command&);
  struct NamedAnswer {
    const char* name;
    Answer answer;
  };
  static const NamedAnswer kCommands[];

  std::string setRegion(Command& command);
  std::string removeRegion(Command& command);
  std::string setSettings(Command& command);
  std::string exclude(Command& command);
  std::string inertia(Command& command);
  std::string massMatrix(Command& command);
  std::string wrench(Command& command);
  std::string wet(Command& command);
  std::string save(Command& command);
  std::string restore(Command& command);
  std::string status(Command& command);
  std::string leave(Command& command);

  void meetWorld();
  void forgetWorld();
  WorldFluid& requireFluid();
  WorldFluid& requireCurrent();

  struct Region {
    FluidRegion region;
    RegionId id = RegionId::kNone;  // in the present world
  };

  Server& server_;
  Client& client_;
  std::unique_ptr<FluidBodyCache> shapes_;  // outlives the fluid
  std::unique_ptr<WorldFluid> fluid_;
  std::string refusal_;  // why the present world has none
  bool has_news_ = true;
  std::map<std::string, Region> regions_;
  FlowSettings flow_;
  CollisionShapeSettings shape_settings_;
  std::string folder_;
  std::string pieces_;  // of a text that is longer than PyBullet takes
};

}  // namespace ambient::pybullet
