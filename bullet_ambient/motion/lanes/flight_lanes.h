#pragma once

#include "bullet_ambient/base/lane_vectors.h"

namespace ambient {

// Data and kernels of the passive leapfrog, docs/theory.md eq. (22) to (25), for several bodies
// side by side, and of motions with rows. Plain data only: kernels are compiled once per
// instruction set, and must share no inline function with the rest of the program.

constexpr int kFlightLanes = 8;

/// One number per body.
using FlightLane = double[kFlightLanes];

/// Number of entries in the upper triangle of a symmetric 6x6 matrix, stored row by row.
constexpr int kSymmetricEntries = 21;
constexpr int symmetricEntry(int row, int column) { return row * (11 - row) / 2 + column; }

/// Symmetric 6x6 matrix, its upper triangle row by row. `Real`: double, or one number per lane.
template <class Real>
struct SymmetricOf {
  Real entries[kSymmetricEntries];
};

/// Twist (w, v) or wrench (torque, force).
template <class Real>
struct SpatialsOf {
  VectorsOf<Real> angular, linear;
};

/// Models of bodies, the forces on them, poses and motions. Vectors are in world axes (_W) or body
/// axes (_B); SI units. 6-vectors and wrenches: rotation first.
struct alignas(64) BodyLanes {
  FlightLane active;  ///< 1: the body moves; 0: kernels keep its pose, motion and last load

  // Constant over the step.
  FlightLane inertia[kSymmetricEntries];          ///< K in B
  FlightLane inverse_inertia[kSymmetricEntries];  ///< K^-1
  FlightLane resistance_there[6][6];              ///< mu R about the centre of reaction
  FlightLane centre_of_reaction[3];               ///< in B
  FlightLane settling;        ///< how quickly it settles the body [1/s]; 0 if not within the step
  bool has_diagonal_inertia;  ///< K, K^-1 and C of all bodies are diagonal
  bool has_loads;             ///< at least one body has surface loads
  bool has_resistance;        ///< at least one body has a resistance
  FlightLane torque_W[3], force_W[3];  ///< wrench without buoyancy and loads, about the centre of
                                       ///< mass
  FlightLane buoyancy_W[3];
  FlightLane centre_of_volume_B[3];

  // Pose and motion.
  FlightLane orientation[4];     ///< (x, y, z, w), B to W
  FlightLane displacement_W[3];  ///< displacement since the start of the step [m]
  FlightLane twist_B[6], momentum_B[6];
  FlightLane kick_time;  ///< duration of the next kick, or of the step with rows [s]
  FlightLane growth[2];  ///< of the resistance at the last load, rotation first; 0: none acts
  FlightLane resistance[kSymmetricEntries];  ///< C of that load, in B: kernels that read it set it
  FlightLane load_B[6];                      ///< surface load; 0 for a body without surface loads
};

/// Input and output of the kernels of free flight.
struct alignas(64) FlightLanes : BodyLanes {
  FlightLane velocity_scale;  ///< result of velocityScale()
  FlightLane precision;       ///< largest error of drift(), relative to the motion [1]

  FlightLane energy;          ///< kinetic and potential energy at the last measure(), eq. (25a) [J]
  FlightLane drift_time;      ///< duration of the next flow [s]
  FlightLane is_coarse;       ///< drift() sets 1 if it did not reach its precision
  FlightLane energy_removed;  ///< drift() and bound() add the energy they remove [J]

  // Within a kick, in which load_B is the load at the sampled twist.
  FlightLane load_W[6];            ///< surface load of the last kick
  FlightLane predicted_load_B[6];  ///< load by which sample() predicts the middle of the kick
  FlightLane gravity_twist[6];     ///< change of twist in half the kick by all but surface loads
  FlightLane gravity_momentum[6];  ///< change of momentum belonging to it
  FlightLane sample_twist[6];
  FlightLane sample_momentum[6];
  FlightLane error;  ///< error e of the kick, docs/theory.md eq. (25)
};

/// Input and output of readStarts(): poses and velocities of a world, converted to body axes.
struct alignas(64) StartLanes {
  FlightLane rotation[9];  ///< B to W, row by row; orthogonal up to its rounding
  FlightLane twist_W[6];

  FlightLane orientation[4];  ///< result: unit quaternion (x, y, z, w)
  FlightLane twist_B[6];      ///< result
};

/// Input and output of findEnds(): poses at start and end, and velocities in world axes.
struct alignas(64) EndLanes {
  FlightLane start_orientation[4], start_position[3];
  FlightLane orientation[4], position[3], twist_B[6];
  double duration;  ///< > 0
  double least;     ///< components of the results with a smaller size become 0; >= 0

  FlightLane twist_W[6];  ///< result: twist at the end
  FlightLane mean_W[6];   ///< result: constant twist from start pose to end pose, turning by at
                          ///< most pi, eq. (29)
};

struct RowLanes;

/// Kernels of one instruction set. readStarts() and findEnds() compute all lanes, others
/// only active bodies unless their comment says otherwise.
struct FlightKernel {
  void (*readStarts)(StartLanes&) noexcept;
  void (*findEnds)(EndLanes&) noexcept;

  /// Moves bodies without loads over drift_time, eq. (22), by power series in time. Energy and
  /// world momenta are conserved up to `precision`; the energy never grows. A body that turns by
  /// more than about 500 rad makes the rest of the way in one stride that keeps the world momenta;
  /// is_coarse is set.
  void (*drift)(FlightLanes&) noexcept;
  /// Applies the first half of the kick by gravity, buoyancy and other forces; to a body with a
  /// resistance sample() and kick() do. Sets predicted_load_B to load_W in B.
  void (*applyGravity)(FlightLanes&) noexcept;
  /// Predicts the motion in the middle of the kick from predicted_load_B: sample_twist,
  /// sample_momentum.
  void (*sample)(FlightLanes&) noexcept;
  /// Applies load_B over the whole kick, eq. (23), then the second half of applyGravity(); to a
  /// body with a resistance all of it by eq. (122). Sets error and load_W.
  void (*kick)(FlightLanes&) noexcept;
  /// Sets `energy` to the kinetic and potential energy of the present state.
  void (*measure)(FlightLanes&) noexcept;
  /// Scales motions down to the measured energy if it is exceeded and torque_W is 0, eq. (25a); a
  /// way that has cost more than that is shortened.
  void (*bound)(FlightLanes&) noexcept;

  // For bodies that constraint rows may move; for all lanes of a register with an active body.

  /// Computes the change of velocity that rows are solved against, eq. (28).
  void (*predictRowVelocity)(RowLanes&) noexcept;
  /// Computes what a body keeps that rows have moved: momentum and energy, eq. (31), (31a).
  void (*conserve)(RowLanes&) noexcept;
  /// Computes the twist from the kept momentum at the end of the step, eq. (31).
  void (*transport)(RowLanes&) noexcept;
};

/// No operation is fused, and lanes are independent: the bits of a body do not depend on the
/// instruction set or on the bodies in other lanes.
extern const FlightKernel kFlightKernelBaseline, kFlightKernelAvx2, kFlightKernelAvx512;

/// Bodies that constraint rows may move, docs/theory.md section 7: input and output of
/// predictRowVelocity(), conserve() and transport(), one after the other. Twists relative to the
/// flow; momenta about the centre of mass.
struct alignas(64) RowLanes : BodyLanes {
  // Input of predictRowVelocity(), with orientations and twist_B at the start of the step, and
  // load_B there.
  FlightLane acceleration_W[3];                ///< acceleration of the flow [m/s^2]
  FlightLane isotropic_inverse_inertia[3][3];  ///< D' of eq. (28b), in B [1/(kg m^2)]
  FlightLane isotropic_inverse_mass;           ///< [1/kg]

  // Results of predictRowVelocity(), see RowVelocity.
  FlightLane change_W[6];
  FlightLane turning_W[6];  ///< X, input of conserve(), too
  FlightLane isotropic_excess_W[6];
  FlightLane turn_number;

  // Input of conserve(), with orientations at the start of the step.
  FlightLane velocity_W[6];  ///< xi of eq. (31)
  FlightLane by_rows_W[6];   ///< d

  // Results of conserve().
  FlightLane
      momentum_W[6];  ///< P of eq. (31) at the start; input of transport(), with orientations at
                      ///< the end of the step and displacement_W, which sets twist_B and momentum_B
  FlightLane moved_turn_number;  ///< m of eq. (28a) for xi
  FlightLane twice_energy;       ///< 2 E of eq. (31a) [J]
};

}  // namespace ambient
