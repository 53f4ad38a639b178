#pragma once

#include "bullet_ambient/motion/flight.h"

namespace ambient {

/// Passive leapfrog with bounded adaptive substeps, docs/theory.md eq. (22) to (25), for each of up
/// to kFlightsTogether bodies. Their states are relative to the frame that moves with the ambient
/// flow.
void flyLeapfrog(Flight* const* flights, int count) noexcept;

}  // namespace ambient
