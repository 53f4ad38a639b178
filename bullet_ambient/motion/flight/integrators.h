#pragma once

#include <utility>

#include "bullet_ambient/motion/flight/flight_task.h"

namespace ambient {

// Functions of enum Integrator. States are relative to the frame that moves with the ambient flow.

/// Passive leapfrog with bounded adaptive substeps, docs/theory.md eq. (22) to (25), for each of up
/// to kFlightsTogether bodies.
void flyLeapfrog(Flight* const* flights, int count) noexcept;

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

using FlyAlone = FlightResult (*)(const FlightTask&, const RigidState& start,
                                  const FlightMemory&) noexcept;
/// All but the leapfrog, which flies several bodies together.
constexpr std::pair<Integrator, FlyAlone> kLoneIntegrators[] = {
    {Integrator::kDormandPrince, flyDormandPrince},
    {Integrator::kRungeKutta4, flyRungeKutta},
    {Integrator::kSymplecticEuler, flySymplecticEuler}};

}  // namespace ambient
