#pragma once

#include "bullet_ambient/motion/flight.h"

namespace ambient {

/// Accurate mode: the embedded pair of orders 5 and 4 of Dormand and Prince (1980) on momenta in
/// world axes, with substeps that keep the estimated error of each below settings.tolerance:
/// of the velocity relative to the motion, eq. (25) of docs/theory.md, of the orientation in
/// radians, of the position in lengths of the body. After settings.max_substeps attempts (0: 1024)
/// the passive leapfrog takes over for the rest of the step, which counts as coarse. `start` and
/// the result are relative to the frame that moves with the ambient flow.
FlightResult flyDormandPrince(const FlightTask& task, const RigidState& start,
                              const FlightMemory& memory) noexcept;

}  // namespace ambient
