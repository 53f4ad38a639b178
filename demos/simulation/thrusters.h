#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "bullet_ambient/force/medium/fluid_region.h"
#include "bullet_ambient/spatial/spatial_vectors.h"
#include "demos/analysis/motion_sample.h"
#include "demos/scene/scene.h"
#include "demos/simulation/prepared_body.h"

namespace ambient {

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
  double command(std::size_t index) const { return commands_.at(index); }

  /// Thrusts at the end of the last step [N], without what dry discs lose.
  const std::vector<double>& thrusts() const { return thrusts_; }
  /// @pre finite, one for each thruster
  void setThrusts(const std::vector<double>& thrusts);
  /// Multiplies the thrusts that a thruster is asked for, and its lag; both 1 at first.
  void setFactors(std::size_t index, double thrust, double lag);
  /// Takes the surface of the water from these regions; without one all discs are wet.
  void setRegions(const std::vector<FluidRegion>& regions);

  /// Lets the thrusts follow the commands for a step h, by implicit Euler: T += (F - T) h / (lag +
  /// h), F the thrust of the command.
  void follow(double time_step);
  /// Gives wrenches about the centre of mass, world axes, to apply(body, wrench). `poseOf(body)`:
  /// MotionSample; `time`: that of the fluid [s].
  template <class PoseOf, class Apply>
  void push(const PoseOf& poseOf, double time, const Apply& apply) const {
    for (std::size_t i = 0; i < defs_.size();) {
      const std::size_t body = defs_[i].body;
      const MotionSample pose = poseOf(body);
      Wrench sum;
      for (; i < defs_.size() && defs_[i].body == body; ++i) sum += wrenchOf(i, pose, time);
      if (sum.torque.isZero(0) && sum.force.isZero(0)) continue;
      apply(body, Wrench{pose.orientation * sum.torque, pose.orientation * sum.force});
    }
  }

 private:
  struct Factors {
    double thrust = 1, lag = 1;
  };

  /// Wrench about the centre of mass, axes of the body.
  Wrench wrenchOf(std::size_t index, const MotionSample& pose, double time) const;
  /// Share of the height of an upright disc that is below the surface.
  double wetShare(std::size_t index, const MotionSample& pose, double time) const;

  std::vector<ThrusterDef> defs_;
  std::vector<Vector3> arms_;       // from the centre of mass, axes of the shape [m]
  std::vector<Wrench> per_thrust_;  // about the centre of mass, same axes
  std::vector<Factors> factors_;
  std::vector<double> commands_, thrusts_;
  std::optional<FluidRegion> water_;  // none: no disc can be dry
};

}  // namespace ambient
