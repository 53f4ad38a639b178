#pragma once

#include "bullet_ambient/motion/flight.h"

namespace ambient {

/// What the turn of the body does to its velocity in a step: by gyroscopic terms, and because the
/// axes of the body turn; in B. Neither does work.
struct Turning {
  Vector6 change;     ///< of the velocity in world axes, written in body axes
  double extent = 0;  ///< m of docs/theory.md eq. (28): 1 where a step turns too far for any of it
};

/// Where the extent is 1.
struct TurnLimits {
  double spin;    ///< [rad/s]
  double change;  ///< over the twist, in the norm of K
};
/// The larger of both over their limits, for a motion.
double extentOf(const BodyModel& model, const Vector6& change, const DualPair& motion,
                const TurnLimits& limits) noexcept;

/// Of a free body with a motion relative to the flow, explicit.
Turning computeTurning(const BodyModel& model, const DualPair& motion, double duration) noexcept;

/// Up to this extent a step follows the turn, and needs no bound of energy.
constexpr double kSlowTurn = 0.5;

/// Change of velocity over one step that the constraint rows are solved against, docs/theory.md eq.
/// (28): that of the forces at the start pose, and half of the turning part, so that rows see the
/// middle of the turn. In world axes: angular and linear velocity change of the centre of mass
/// [rad/s, m/s].
struct RowVelocity {
  Twist change_W;
  Twist turning_W;    ///< X of eq. (28): the share of the turning part in it
  Twist aside_W;      ///< k' - k of eq. (28b): to what an even response would have changed it
  double extent = 0;  ///< of the turn
  FlightCount count;
};
RowVelocity computeRowVelocity(const FlightTask& task, const RigidState& start) noexcept;

}  // namespace ambient
