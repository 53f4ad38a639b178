#pragma once

#include "bullet_ambient/motion/body_model.h"
#include "bullet_ambient/motion/flight_memory.h"
#include "bullet_ambient/motion/flight_settings.h"
#include "bullet_ambient/motion/rigid_state.h"

namespace ambient {

/// What acts on the body during one step besides the surface loads. World axes; constant over the
/// step.
struct Surroundings {
  Vector3 gravity = Vector3::Zero();  ///< that makes the hydrostatic pressure [m/s^2]
  Wrench applied;  ///< all other forces, weight included, and torque about the centre of mass
  Vector3 ambient_velocity = Vector3::Zero();      ///< at the start of the step [m/s]
  Vector3 ambient_acceleration = Vector3::Zero();  ///< [m/s^2]
};

struct FlightCount {
  int substeps = 0;
  int load_evaluations = 0;
  int guarded = 0;  ///< evaluations in which the passivity guard acted
  bool coarse =
      false;  ///< the bound on substeps or retries was reached with the error above tolerance
  double error = 0;  ///< of the velocity in a coarse step, relative to the motion; 1: not known
  /// The motion ended before the step: beyond, no substep keeps the energy, docs/theory.md eq.
  /// (64).
  bool halted = false;
  double energy_removed = 0;  ///< by bounds, docs/theory.md eq. (22), (25a), (64), (68) [J]
};

struct FlightResult {
  RigidState state;  ///< twist absolute, in B
  FlightMemory memory;
  FlightCount count;
};

/// Weight, buoyancy and inertial forces of the ambient acceleration in B, docs/theory.md eq. (18)
/// and (19), for the orientation R, B to W.
Wrench externalWrench(const BodyModel& model, const Surroundings& surroundings, const Matrix3& R);

/// One body over one step.
struct FlightTask {
  const BodyModel& model;
  const Surroundings& surroundings;
  const FlightSettings& settings;
  double duration;  ///< [s], > 0
};

/// Size in the metric of K of the motion of a body that falls by its own size: it is added to that
/// of its motion where errors of the velocity are compared with it, in the denominator of
/// docs/theory.md eq. (25) [sqrt(J)].
double fallScale(const FlightTask& task);

/// Integrates Kirchhoff's equations with loads over the task's duration from `start` (twist
/// absolute, in B). Works in the frame that moves with the ambient flow. Allocates nothing. The
/// result is not finite if the input or a load is not: check before use.
FlightResult fly(const FlightTask& task, const RigidState& start,
                 const FlightMemory& memory) noexcept;

/// A task and where the body is: at the start before flyTogether(), at the end after it.
struct Flight {
  Flight(const FlightTask& given, const RigidState& start, const FlightMemory& memory)
      : task(given), body{start, memory, {}} {}

  FlightTask task;
  FlightResult body;
};

/// As many bodies as flyTogether() moves side by side.
constexpr int kFlightsTogether = 8;

/// fly() for each of several bodies, with the same bits. Up to kFlightsTogether of them that the
/// passive leapfrog moves take little more time than one, besides their loads.
void flyTogether(Flight* const* flights, int count) noexcept;

}  // namespace ambient
