#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bullet_ambient/spatial/vector_types.h"
#include "bullet_ambient/wind.h"
#include "preprocess/builder/body_maker.h"

namespace ambient {

/// Effect of a column of the actions; sizes by thrusters T, foils F and joints J of the scene.
enum class ActionKind {
  kThrusters,      ///< T commands, clipped to -1 to 1
  kFoils,          ///< F commands of foils likewise
  kWrench,         ///< torque about the centre of mass [N m], force [N]; axes of the body's shape
  kWrenchWorld,    ///< the same in world axes
  kJointTorque,    ///< J torques [N m] or forces [N]
  kMotorPosition,  ///< J positions of motors [rad] or [m]
  kMotorVelocity   ///< J velocities of motors [rad/s] or [m/s]
};
constexpr std::array<std::pair<ActionKind, const char*>, 7> kActionNames{
    {{ActionKind::kThrusters, "thrusters"},
     {ActionKind::kFoils, "foils"},
     {ActionKind::kWrench, "wrench"},
     {ActionKind::kWrenchWorld, "wrench_world"},
     {ActionKind::kJointTorque, "joint_torque"},
     {ActionKind::kMotorPosition, "motor_position"},
     {ActionKind::kMotorVelocity, "motor_velocity"}}};

/// Quantity that varies from episode to episode; in the order in which it is applied.
enum class VariationKind {
  kMass,           ///< factor on mass and moments of inertia
  kInertia,        ///< factor on moments of inertia
  kAddedMass,      ///< AttachDef::added_mass_factor
  kLoads,          ///< AttachDef::load_factor
  kFriction,       ///< factor on the coefficient of friction
  kCentreOfMass,   ///< offset of the centre of mass in axes of the body's shape [m], 3
  kThrust,         ///< factors on the T thrusts
  kLag,            ///< factor on the lags of all thrusters
  kCurrent,        ///< velocity of all fluids besides that of the scene [m/s], 3
  kGust,           ///< factor on GaussMarkovGusts::intensity
  kPosition,       ///< added to the position at the start [m], 3
  kHeading,        ///< turn about the world's z axis at the start [rad]
  kAttitude,       ///< rotation vector at the start, axes of the body [rad], 3
  kTwist,          ///< added to the twist at the start, world axes, 6
  kJointPosition,  ///< added to the J positions at the start [rad] or [m]
  kTarget          ///< the world's target, a point [m], 3
};
constexpr std::array<std::pair<VariationKind, const char*>, 16> kVariationNames{
    {{VariationKind::kMass, "mass"},
     {VariationKind::kInertia, "inertia"},
     {VariationKind::kAddedMass, "added_mass"},
     {VariationKind::kLoads, "loads"},
     {VariationKind::kFriction, "friction"},
     {VariationKind::kCentreOfMass, "centre_of_mass"},
     {VariationKind::kThrust, "thrust"},
     {VariationKind::kLag, "lag"},
     {VariationKind::kCurrent, "current"},
     {VariationKind::kGust, "gust"},
     {VariationKind::kPosition, "position"},
     {VariationKind::kHeading, "heading"},
     {VariationKind::kAttitude, "attitude"},
     {VariationKind::kTwist, "twist"},
     {VariationKind::kJointPosition, "joint_position"},
     {VariationKind::kTarget, "target"}}};

/// Columns of the actions.
struct ActionDef {
  std::string kind;
  std::string body = {};       ///< empty: the first body that moves
  std::vector<int> rows = {};  ///< those of its numbers that are actions; empty: all
  double scale = 1;            ///< factor on the actions
};

/// Columns of the observations, by the names of observationNames().
struct ObservationDef {
  std::string kind;
  std::string body = {};
  std::vector<int> rows = {};
  Vector3 place = Vector3::Zero();  ///< of a sensor, from the centre of mass, axes of the shape [m]
  double noise = 0;                 ///< standard deviation of each reading
  double bias = 0;                  ///< standard deviation of what an episode adds to all readings
};

/// Bounds between which each episode draws evenly; of one number for all, or one for each.
struct VariationDef {
  std::string kind;
  std::string body = {};
  std::vector<double> lowest, highest;
  bool is_logarithmic = false;  ///< the logarithm is drawn evenly
};

/// Settings of a WorldBatch.
struct BatchSettings {
  int worlds = 1;
  int substeps = 1;          ///< steps of the scene in an env step
  int threads = 0;           ///< 0: all cores
  int together = 8;          ///< worlds whose flights are computed side by side; 1: each alone
  std::uint64_t seed = 0;    ///< world i has seed + i
  long long most_steps = 0;  ///< env steps after which a world is truncated; 0: never
  std::vector<ActionDef> actions = {};
  std::vector<ObservationDef> observations = {};
  std::vector<VariationDef> variations = {};
  /// Reach all fluids of a world, which has a seed of its own in each episode; sampled at the ends
  /// of env steps and linear in between, with the acceleration that belongs to it.
  std::optional<GaussMarkovGusts> gust = std::nullopt;
  BodyFolder fluid_bodies = {};
};

/// Columns of actions, observations or parameters that belong together.
struct BatchField {
  std::string name;  ///< kind, or kind:body if a body was named
  int offset = 0, size = 0;
};

}  // namespace ambient
