#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "demos/pybullet/command.h"
#include "demos/pybullet/world_fluid.h"
#include "demos/scene/scene.h"
#include "demos/simulation/scene_foils.h"
#include "demos/simulation/thrusters.h"

namespace ambient::pybullet {

/// Foils and thrusters on bodies and links of one world, by the readers and with the loads of
/// scenes. "3" and "3/0" are the names of PyBullet's body 3 and of its link 0. Places and axes are
/// in the frame of their centre of mass.
class Equipment {
 public:
  /// What changes from step to step; of all that has come since it is unchanged.
  struct State {
    std::vector<ThrusterState> thrusters;
    std::vector<double> foil_angles;
  };

  Equipment() { scene_.file = "equip"; }  // begins messages

  /// Adds those of a command `equip`. All of their bodies are in the fluid, and are added to it
  /// anew. @throws std::exception with one line
  void add(const Command& command, WorldFluid& world, const WorldFluid::Settings& settings);
  /// Sets what they are asked for, of a command `drive`: names and values.
  /// @throws std::invalid_argument with one line
  void drive(const Command& command);
  /// Takes those off that are on a body, or on one link of it.
  void forget(int body, int link);
  /// Lets them follow their commands for a step [s], and pushes their bodies. `regionOf`: null if
  /// there is none. Call before each substep.
  void push(double time_step, WorldFluid& world,
            const std::function<const FluidRegion*(RegionId)>& regionOf);
  /// Thrusts, angles and what they are asked for, by name.
  nlohmann::ordered_json state() const;

  bool isEmpty() const { return scene_.bodies.empty(); }
  State saved() const { return {thrusters_.states(), foils_.angles()}; }
  void restore(const State& state);

 private:
  /// A body or link, whose numbers are its name in the scene.
  struct Carrier {
    int body = 0, link = -1;
    bool is_gone = false;     ///< all of it was taken off, and has no names
    FrameOffset fluid_frame;  ///< F in the frame of its centre of mass
    WorldFluid::Push push;    ///< last one
  };

  void addCarrier(const nlohmann::json& entry, const WorldFluid& world);
  void read(const nlohmann::json& values, const WorldFluid& world);

  Scene scene_;  ///< bodies, thrusters and foils alone
  std::vector<Carrier> carriers_;
  Thrusters thrusters_;
  SceneFoils foils_;
};

}  // namespace ambient::pybullet
