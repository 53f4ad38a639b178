#pragma once

#include "bullet_ambient/motion/flight.h"

namespace ambient {

/// Symplectic Euler with Lie-group update of the orientation, the default of Padilla et al. 2025:
/// momentum in B by the rates at the start, then the pose by the new twist. In equal substeps as
/// many as settings.max_substeps says, 0: one. Not stable at every speed: to compare with. `start`
/// and the result are relative to the frame that moves with the ambient flow.
FlightResult flySymplecticEuler(const FlightTask& task, const RigidState& start) noexcept;

}  // namespace ambient
