#pragma once

#include "bullet_ambient/motion/flight/flight_task.h"

namespace ambient {

/// Integrates Kirchhoff's equations with loads over the task's duration. `start`: pose in W, twist
/// absolute, in B. Works in the frame that moves with the ambient flow. Allocates nothing. The
/// result is not finite if the input or a load is not: check before use.
FlightResult fly(const FlightTask& task, const RigidState& start,
                 const FlightMemory& memory) noexcept;

/// Like fly(), for several bodies, with the same bits; results replace the input in Flight::body.
/// With the passive leapfrog kFlightsTogether bodies cost little more than one, loads excepted.
void flyTogether(Flight* const* flights, int count) noexcept;

/// Passive leapfrog with bounded adaptive substeps, docs/theory.md eq. (22) to (25), for each of up
/// to kFlightsTogether bodies. States are relative to the frame that moves with the ambient flow.
void flyLeapfrog(Flight* const* flights, int count) noexcept;

}  // namespace ambient
