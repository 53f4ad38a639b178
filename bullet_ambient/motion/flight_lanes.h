#pragma once

namespace ambient {

// The leapfrog's arithmetic for several bodies at once. Plain data only: the kernels are compiled
// once per instruction set, and must not share an inline function with the rest of the program.

constexpr int kFlightLanes = 8;

/// One value of each body.
using FlightLane = double[kFlightLanes];

/// Entries of a symmetric 6x6 matrix, row by row from the diagonal on.
constexpr int kSymmetricEntries = 21;
constexpr int symmetricEntry(int row, int column) { return row * (11 - row) / 2 + column; }

/// What the kernels read and write. Vectors in world axes (W) or body axes (B); SI units.
struct alignas(64) FlightLanes {
  FlightLane active;  ///< 1: the body moves; 0: its pose, motion and last load stay

  // Constant over the step.
  FlightLane inertia[kSymmetricEntries];          ///< K in B
  FlightLane inverse_inertia[kSymmetricEntries];  ///< K^-1
  bool has_diagonal_inertia;  ///< all of them: other entries than those of the diagonals are 0
  bool has_loads;             ///< at least one body has surface loads
  FlightLane torque_W[3], force_W[3];  ///< on the body about its centre of mass, without buoyancy
  FlightLane buoyancy_W[3];
  FlightLane centre_of_volume_B[3];
  FlightLane fall_scale;  ///< fallScale()
  FlightLane precision;   ///< of flows, relative to the motion

  // Pose and motion.
  FlightLane orientation[4];  ///< (x, y, z, w), B to W
  FlightLane way_W[3];        ///< from where the step began
  FlightLane twist_B[6], momentum_B[6];
  FlightLane energy;  ///< of body and fluid, with that of position, when last measured, eq. (25a)

  FlightLane flow_time;       ///< of the next flow
  FlightLane kick_time;       ///< of the next kick
  FlightLane is_coarse;       ///< set to 1 by a flow that was too long for its precision
  FlightLane energy_removed;  ///< flow() and bound() add what they take from the motion [J]

  // Within a kick. A wrench is a torque and a force; all are 0 for a body without surface loads.
  FlightLane load_W[6];      ///< the last one
  FlightLane guess_B[6];     ///< of the load, before the sample
  FlightLane load_B[6];      ///< at the sample
  FlightLane fall_twist[6];  ///< change by gravity in half the kick
  FlightLane fall_momentum[6];
  FlightLane sample_twist[6];
  FlightLane sample_momentum[6];
  FlightLane error;  ///< of the kick, docs/theory.md eq. (25)
};

/// Poses and velocities as a world has them, to be turned into body axes.
struct alignas(64) DepartureLanes {
  FlightLane rotation[9];  ///< B to W, row by row; orthogonal up to its rounding
  FlightLane twist_W[6];

  FlightLane orientation[4];  ///< result: unit, (x, y, z, w)
  FlightLane twist_B[6];      ///< result
};

/// From poses at the start and states at the end to velocities in world axes.
struct alignas(64) ArrivalLanes {
  FlightLane start_orientation[4], start_position[3];
  FlightLane orientation[4], position[3], twist_B[6];
  double duration;  ///< > 0
  double least;     ///< components of the results below it are 0; >= 0

  FlightLane twist_W[6];  ///< result: at the end
  FlightLane mean_W[6];   ///< result: constant twist that takes the start to the end, by at most
                          ///< half a turn, eq. (29)
};

/// What is done to many bodies at once; the steps of a substep act on all active ones.
struct FlightKernel {
  void (*depart)(DepartureLanes&) noexcept;
  void (*arrive)(ArrivalLanes&) noexcept;

  /// Motion without loads over flow_time, eq. (22). Energy, world momentum and angular momentum
  /// stay up to the precision, and the energy never grows. Power series of as many terms as are
  /// needed for that; a body that turns by more than about 500 rad gets a cruder rest of the way
  /// that keeps the momenta.
  void (*flow)(FlightLanes&) noexcept;
  /// First half of gravity's part of the kick. Turns the last load into B: guess_B.
  void (*fall)(FlightLanes&) noexcept;
  /// From guess_B: the motion in the middle of the kick, where the load is to be evaluated.
  void (*sample)(FlightLanes&) noexcept;
  /// From load_B: the whole kick, eq. (23), its error, load_W, and the other half of gravity's
  /// part.
  void (*kick)(FlightLanes&) noexcept;
  /// Measures the energy.
  void (*measure)(FlightLanes&) noexcept;
  /// Scales motions down to the energy that was measured, where no torque is applied, eq. (25a).
  void (*bound)(FlightLanes&) noexcept;
};

/// No operation is fused, and bodies do not mix: all instruction sets give the same bits, whoever
/// flies beside a body.
extern const FlightKernel kFlightKernelBaseline, kFlightKernelAvx2, kFlightKernelAvx512;

}  // namespace ambient
