#pragma once

#include "bullet_ambient/motion/flight.h"

namespace ambient {

/// Passive leapfrog with bounded adaptive substeps, docs/theory.md eq. (22) to (25). `start` and
/// the result are relative to the frame that moves with the ambient flow.
FlightResult flyLeapfrog(const FlightTask& task, const RigidState& start,
                         const FlightMemory& memory) noexcept;

}  // namespace ambient
