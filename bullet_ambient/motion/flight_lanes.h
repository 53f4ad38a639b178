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
  FlightLane position_W[3];
  FlightLane twist_B[6], momentum_B[6];

  FlightLane flow_time;  ///< of the next flow
  FlightLane kick_time;  ///< of the next kick
  FlightLane is_coarse;  ///< set to 1 by a flow that was too long for its precision

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

/// The steps of a substep; each acts on all active bodies.
struct FlightKernel {
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
};

/// No operation is fused, and bodies do not mix: all instruction sets give the same bits, whoever
/// flies beside a body.
const FlightKernel& baselineFlightKernel() noexcept;
#if defined(__x86_64__)
const FlightKernel& avx2FlightKernel() noexcept;
const FlightKernel& avx512FlightKernel() noexcept;
#endif

}  // namespace ambient
