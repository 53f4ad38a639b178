#pragma once

#include <cmath>
#include <cstddef>
#include <type_traits>
#include <vector>

#include "bullet_ambient/force/medium/fluid_region.h"
#include "bullet_ambient/spatial/spatial_vectors.h"
#include "demos/analysis/motion_sample.h"
#include "demos/scene/scene.h"
#include "demos/simulation/prepared_body.h"

namespace ambient {

/// State of a thruster; plain numbers, as saved states hold them.
struct ThrusterState {
  double drive = 0;    ///< what follows the command: thrust [N], or turns [1/s]
  double advance = 0;  ///< of a propeller in the last step [m/s]
  double density = 0;  ///< of the fluid at its disc then, times the share of the disc in it
  PropellerLoad load;  ///< in the last step, without what dry discs lose; without a propeller: its
                       ///< thrust alone

  bool isFinite() const {
    return std::isfinite(drive + advance + density + load.thrust + load.torque + load.power +
                         load.induced);
  }
};
static_assert(std::is_trivially_copyable_v<ThrusterState>);

/// Thrusters of a scene: their commands, and the thrusts that follow these.
class Thrusters {
 public:
  Thrusters() = default;
  /// @pre `bodies` are those of the scene
  Thrusters(const Scene& scene, const std::vector<PreparedBody>& bodies);

  std::size_t size() const { return defs_.size(); }
  const ThrusterDef& def(std::size_t index) const { return defs_.at(index); }
  /// Sets what a thruster is asked for, from the next step on.
  /// @throws std::invalid_argument, naming the thruster, if it is not finite
  void command(std::size_t index, double value);
  double command(std::size_t index) const { return drives_.at(index).command; }

  const std::vector<ThrusterState>& states() const { return states_; }
  /// @pre finite, one for each thruster
  void setStates(const std::vector<ThrusterState>& states);
  /// Multiplies the thrusts of a thruster, and its lag; both 1 at first.
  void setFactors(std::size_t index, double thrust, double lag);

  /// Sets the places of the thrusters of a body for another centre of mass, in axes of the shape
  /// [m].
  void setCentre(std::size_t body, const Vector3& centre_of_mass);

  /// Lets the drives follow the commands for a step h, by implicit Euler: T += (F - T) h / (lag +
  /// h), F the drive of the command.
  void follow(double time_step);
  /// Whether a propeller washes bodies.
  bool hasJets() const { return jets_.capacity() > 0; }
  /// Velocity that the jets of propellers that wash bodies add to a fluid at a point in W, the
  /// upper one or the one below the surface.
  Vector3 washAt(const Vector3& point, bool is_above) const;
  /// Puts the jets where the discs are, with the loads of the last step. Arguments as push().
  template <class PoseOf, class FluidAt>
  void renewJets(const PoseOf& poseOf, const FluidAt& fluidAt) {
    jets_.clear();
    for (std::size_t i = 0, count = defs_.size(); i < count; ++i) {
      const double induced = states_[i].load.induced;
      if (!defs_[i].washes_bodies || induced == 0) continue;
      const MotionSample pose = poseOf(defs_[i].body);
      const Vector3 place = placeOf(i, pose), axis = pose.orientation * defs_[i].axis;
      const bool is_above = !(wetShareOf(i, fluidAt(defs_[i].body, place)) > 0);
      jets_.push_back({i, place, induced < 0 ? axis : Vector3(-axis), is_above});
    }
  }

  /// Gives wrenches about the centre of mass, world axes, to apply(body, wrench). `poseOf(body)`:
  /// MotionSample; `fluidAt(body, place)`: RegionSample around a point in W.
  template <class PoseOf, class FluidAt, class Apply>
  void push(const PoseOf& poseOf, const FluidAt& fluidAt, const Apply& apply) {
    for (std::size_t i = 0, count = defs_.size(); i < count;) {
      const std::size_t body = defs_[i].body;
      const MotionSample pose = poseOf(body);
      Vector6 sum = Vector6::Zero();
      for (; i < count && defs_[i].body == body; ++i) {
        if (readsFluid(i))
          sum += wrenchIn(fluidAt(body, placeOf(i, pose)), i, pose).vector();
        else
          sum += states_[i].load.thrust * drives_[i].per_thrust;
      }
      if (sum.isZero(0)) continue;
      const Wrench push = Wrench::fromVector(sum);
      apply(body, Wrench{pose.orientation * push.torque, pose.orientation * push.force});
    }
  }

 private:
  struct Drive {
    double command = 0, thrust_factor = 1;
    double asked = 0;      // of the drive, for the command
    double lag = 0;        // [s]
    bool has_disc = true;  // false: the drive is the thrust, wherever it is
    Vector6 per_thrust;    // wrench about the centre of mass, axes of the shape
  };

  struct Jet {
    std::size_t thruster = 0;
    Vector3 place, away;  // of the disc in W, and the way that the jet goes
    bool is_above = false;
  };

  void setAsked(std::size_t index);
  /// Share of a disc below the surface.
  double wetShareOf(std::size_t index, const RegionSample& fluid) const;
  /// Whether the fluid at the disc counts: of a propeller, and where a thrust could be dry.
  bool readsFluid(std::size_t index) const {
    return drives_[index].has_disc && (defs_[index].propeller || states_[index].drive != 0);
  }
  Vector3 placeOf(std::size_t index, const MotionSample& pose) const {
    return pose.position + pose.orientation * arms_[index];
  }
  /// Wrench about the centre of mass, axes of the body. Keeps the load.
  Wrench wrenchIn(const RegionSample& fluid, std::size_t index, const MotionSample& pose);
  /// Velocity of a disc relative to a fluid, axes of the body.
  Vector3 velocityIn(const Medium& medium, std::size_t index, const MotionSample& pose) const;

  std::vector<ThrusterDef> defs_;
  std::vector<Vector3> arms_;  // from the centre of mass, axes of the shape [m]
  std::vector<Drive> drives_;
  std::vector<ThrusterState> states_;
  std::vector<Jet> jets_;
};

}  // namespace ambient
