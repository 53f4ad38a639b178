#pragma once

#include "bullet_ambient/motion/body/body_model.h"
#include "bullet_ambient/motion/flight/flight_task.h"

namespace ambient {

/// Unknowns of Kirchhoff's equations in world axes, or rates of the unknowns [per s]. The
/// orientation need not be normalised between stages.
struct MomentumPhase {
  Eigen::Vector4d orientation;  ///< quaternion x, y, z, w
  Vector3 position;             ///< [m]
  Vector3 linear;               ///< momentum P [kg m/s]
  Vector3 angular;              ///< momentum L about the pivot [kg m^2/s]

  MomentumPhase plus(double h, const MomentumPhase& rate) const {
    return {orientation + h * rate.orientation, position + h * rate.position,
            linear + h * rate.linear, angular + h * rate.angular};
  }
};

/// Kirchhoff's equations with loads for one body over one step, docs/theory.md eq. (2) and (18) to
/// (21), for explicit integrators. Adds the number of load evaluations to `count`.
class MomentumEquations {
 public:
  /// `start` is relative to the frame that moves with the ambient flow; its position is the pivot.
  MomentumEquations(const FlightTask& task, const RigidState& start, FlightCount& count);

  const MomentumPhase& start() const { return start_; }
  MomentumPhase rate(const MomentumPhase& phase) const;
  RigidState stateOf(const MomentumPhase& phase) const;

 private:
  const FlightTask& task_;
  Vector3 pivot_;
  MomentumPhase start_;
  FlightCount& count_;
};

}  // namespace ambient
