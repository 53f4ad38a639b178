#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "bullet_ambient/force/loads/foils.h"
#include "bullet_ambient/force/medium/fluid_region.h"
#include "demos/analysis/motion_sample.h"
#include "demos/scene/scene.h"
#include "demos/simulation/prepared_body.h"
#include "demos/simulation/thrusters.h"

namespace ambient {

/// Foils of a scene: their commands, the angles that follow these, and the wash of propellers on
/// them. All other loads on them are of their bodies, FlowSettings::foils.
class SceneFoils {
 public:
  SceneFoils() = default;
  /// @pre `bodies` are those of the scene
  SceneFoils(const Scene& scene, const std::vector<PreparedBody>& bodies);

  std::size_t size() const { return placed_.size(); }
  const FoilDef& def(std::size_t index) const { return placed_.at(index).def; }
  /// Foils of a body of the scene; null: it has none.
  std::shared_ptr<const Foils> of(std::size_t body) const;
  /// Sets what a foil is asked for, from the next step on; without effect on one that is fixed.
  /// @throws std::invalid_argument, naming the foil, if it is not finite
  void command(std::size_t index, double value);
  double command(std::size_t index) const { return placed_.at(index).command; }
  double angle(std::size_t index) const;
  std::vector<double> angles() const;
  /// @pre finite, one for each foil
  void setAngles(const std::vector<double>& angles);

  /// Moves the foils of a body to its new centre of mass, so that they stay in place on the shape
  /// [m].
  void setCentre(std::size_t body, const Vector3& centre_of_mass);

  /// Lets the angles follow the commands for a step, by implicit Euler as Thrusters do.
  void follow(double time_step);
  /// Gives what the propellers of a foil's own body add to its loads by their wash: wrenches about
  /// the centre of mass, world axes, to apply(body, wrench). Arguments as Thrusters::push(), which
  /// has made the loads of the thrusters.
  template <class PoseOf, class FluidAt, class Apply>
  void pushByWash(const Thrusters& thrusters, const PoseOf& poseOf, const FluidAt& fluidAt,
                  const Apply& apply) const {
    for (const Placed& placed : placed_)
      for (const std::size_t thruster : placed.thrusters) {
        if (thrusters.states()[thruster].load.induced == 0) continue;
        const MotionSample pose = poseOf(placed.def.body);
        const RegionSample fluid =
            fluidAt(placed.def.body, pose.position + pose.orientation * placed.arm);
        const Wrench wrench = washOn(placed, thrusters, thruster, pose, fluid);
        apply(placed.def.body,
              Wrench{pose.orientation * wrench.torque, pose.orientation * wrench.force});
      }
  }

 private:
  struct Placed {
    FoilDef def;
    std::shared_ptr<Foils> foils;        ///< of its body
    std::size_t index = 0;               ///< among these
    Vector3 arm{0, 0, 0};                ///< from the centre of mass, axes of the shape [m]
    Vector3 origin_S{0, 0, 0};           ///< of F in the frame of the shape [m]
    Vector3 origin{0, 0, 0};             ///< of F, from the centre of mass [m]
    std::vector<std::size_t> thrusters;  ///< propellers of its body
    double command = 0;
  };

  /// Wrench about the centre of mass, axes of the shape.
  static Wrench washOn(const Placed& placed, const Thrusters& thrusters, std::size_t thruster,
                       const MotionSample& pose, const RegionSample& fluid);

  std::vector<Placed> placed_;
};

}  // namespace ambient
