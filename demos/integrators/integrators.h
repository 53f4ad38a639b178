#pragma once

#include <array>
#include <utility>

#include "bullet_ambient/motion/body/body_model.h"
#include "bullet_ambient/motion/flight/flight.h"

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

// The paper's integrators and a reference, as FlightSettings::own_flight. States are relative to
// the frame that moves with the ambient flow.

/// Fourth-order Runge-Kutta with substeps so that |w| h < 5.7 degrees, docs/theory.md eq. (21),
/// Padilla et al. 2025, section 4.4. Unlike [Padilla 2025], the unknowns are the momenta in world
/// axes, so that without loads they stay constant to rounding.
FlightResult flyRungeKutta(const FlightTask& task, const RigidState& start,
                           const FlightMemory&) noexcept;

/// Accurate mode: embedded pair of orders 5 and 4 of Dormand and Prince (1980), on momenta in world
/// axes. Each substep keeps three estimated errors below settings.tolerance: velocity relative to
/// the motion, docs/theory.md eq. (25); orientation [rad]; position in lengths of the body. After
/// settings.max_substeps attempts (0: 1024) the passive leapfrog integrates the rest of the step,
/// which counts as coarse.
FlightResult flyDormandPrince(const FlightTask& task, const RigidState& start,
                              const FlightMemory& memory) noexcept;

/// Symplectic Euler with Lie-group update of the orientation, the default of Padilla et al. 2025:
/// momentum in B by the rates at the start, then the pose by the new twist. In equal substeps as
/// many as settings.max_substeps says, 0: one. Not stable at every speed: to compare with.
FlightResult flySymplecticEuler(const FlightTask& task, const RigidState& start,
                                const FlightMemory&) noexcept;

/// Names of the integrators in scenes and summaries.
constexpr std::array<std::pair<OwnFlight, const char*>, 4> kIntegratorNames{
    {{nullptr, "leapfrog"},
     {flyDormandPrince, "dormand_prince"},
     {flyRungeKutta, "rk4"},
     {flySymplecticEuler, "symplectic_euler"}}};

}  // namespace ambient
