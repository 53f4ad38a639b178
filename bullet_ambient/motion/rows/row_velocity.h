#pragma once

#include "bullet_ambient/motion/body/body_model.h"
#include "bullet_ambient/motion/flight/flight_task.h"

namespace ambient {

/// Largest extent m at which a step needs no bound of the energy, docs/theory.md eq. (31a).
constexpr double kSlowTurn = 0.5;

/// Change of velocity over one step that constraint rows are solved against, docs/theory.md eq.
/// (28): k by the forces at the start pose, plus X, half of the turning part, so that rows see the
/// middle of the turn. World axes: change of angular velocity [rad/s] and of the velocity of the
/// centre of mass [m/s].
struct RowVelocity {
  Twist change_W;            ///< k + X, and the acceleration of the ambient flow
  Twist turning_W;           ///< X of eq. (28), contained in change_W
  Twist isotropic_excess_W;  ///< k' - k of eq. (28b): with isotropic added mass minus the true one
  double extent = 0;         ///< m of eq. (28a); from 1 on X = 0, the turn is too large
  FlightCount count;
};

/// A body at the start of a step in which rows may move it.
struct RowTask {
  FlightTask task;
  const RigidState& start;
};

/// Computes the changes of up to kFlightsTogether free bodies side by side. The bits of a body do
/// not depend on the others.
void computeRowVelocities(const RowTask* const* bodies, int count, RowVelocity* results) noexcept;
RowVelocity computeRowVelocity(const FlightTask& task, const RigidState& start) noexcept;

/// Returns the mean wrench in B of the kick by a load in fluid that turns with a body,
/// FlowAlongBody with one station, less FlowAlongBody::at_rest_B; docs/theory.md eq. (87). `load`:
/// of computeSurfaceLoad() at the twist `relative`.
Wrench meanLoadInTurningFluid(const FlightTask& task, const BodyModel& model, const Twist& relative,
                              const Wrench& load) noexcept;
/// True if the surroundings have such a fluid.
inline bool turnsWithFluid(const Surroundings& s) { return s.flow && s.flow->stations == 1; }

// Momentum and energy that a body keeps on the way that Bullet moves it with rows, docs/theory.md
// eq. (31) and (31a). Functions for up to kFlightsTogether bodies side by side; the bits of a body
// do not depend on the others. Velocities relative to the flow.

/// A body after the rows of a step, before Bullet moves it; world axes.
struct BodyWithRows {
  const BodyModel& model;
  Quaternion orientation;  ///< B to W
  Twist velocity_W;        ///< xi: velocity with which Bullet moves it
  Twist turning_W;         ///< X of eq. (28)
  Twist by_rows_W;         ///< d: change by the rows
};

struct KeptMotion {
  Momentum momentum_W;      ///< P of eq. (31), about the centre of mass at the start
  double extent = 0;        ///< m of eq. (28a) for xi
  double twice_energy = 0;  ///< 2 E of eq. (31a) [J]
};

/// Computes what the bodies keep over a step of `duration` [s].
void computeKeptMotions(const BodyWithRows* const* bodies, int count, double duration,
                        KeptMotion* results) noexcept;

/// A body where Bullet has moved it.
struct CarriedBody {
  const BodyModel& model;
  Quaternion orientation;  ///< B to W, at the end of its way
  Momentum momentum_W;     ///< KeptMotion::momentum_W
  Vector3 way_W;           ///< way of the centre of mass since the start, relative to the flow [m]
};

/// Computes the twists in B of bodies from the momenta that they keep.
void computeCarriedTwists(const CarriedBody* const* bodies, int count, Twist* twists_B) noexcept;

}  // namespace ambient
