#pragma once

#include "bullet_ambient/motion/lanes/flight_lanes.h"

namespace ambient {

// Data of the kernels for bodies that constraint rows move, docs/theory.md section 7, side by side.
// Plain data only, as in flight_lanes.h.

/// Input and output of FlightKernel::push(): change of velocity that rows are solved against.
struct alignas(64) PushLanes {
  /// Models, surroundings, orientations; kick_time: duration of the step [s]; twist_B: twist
  /// relative to the flow; load_B: surface load at that twist.
  FlightLanes bodies;
  FlightLane acceleration_W[3];           ///< acceleration of the flow [m/s^2]
  FlightLane even_inverse_inertia[3][3];  ///< D' of eq. (28b), in B [1/(kg m^2)]
  FlightLane even_inverse_mass;           ///< [1/kg]

  // Results, see RowVelocity.
  FlightLane change_W[6];
  FlightLane turning_W[6];
  FlightLane isotropic_excess_W[6];
  FlightLane extent;
};

/// Input and output of FlightKernel::keep(), which computes the momentum of a body that rows have
/// moved, and of carry(), which computes the twist of that momentum in the next pose. Twists
/// relative to the flow; momenta about the centre of mass.
struct alignas(64) RowMotionLanes {
  /// Models; kick_time: duration of the step [s]. keep(): orientations at the start of the step.
  /// carry(): those at its end, way_W; results in twist_B and momentum_B.
  FlightLanes bodies;
  FlightLane velocity_W[6];  ///< xi of eq. (31)
  FlightLane turning_W[6];   ///< X
  FlightLane by_rows_W[6];   ///< d
  FlightLane momentum_W[6];  ///< P of eq. (31) at the start: result of keep(), input of carry()

  // Results of keep().
  FlightLane extent;        ///< m of eq. (28a) for xi
  FlightLane twice_energy;  ///< 2 E of eq. (31a) [J]
};

}  // namespace ambient
