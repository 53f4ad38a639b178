#pragma once

#include "bullet_ambient/motion/flight.h"

namespace ambient {

/// Fourth-order Runge-Kutta with substeps so that |w| h < 5.7 degrees, docs/theory.md eq. (21),
/// Padilla et al. 2025, section 4.4. Unlike [Padilla 2025], the unknowns are the momenta in world
/// axes, so that without loads they stay constant to rounding. `start` and the result are relative
/// to the frame that moves with the ambient flow.
FlightResult flyRungeKutta(const FlightTask& task, const RigidState& start) noexcept;

}  // namespace ambient
