#pragma once

#include "bullet_ambient/motion/flight.h"

namespace ambient {

/// How far a body turns within one step: by how much of the velocity its gyroscopic terms change
/// it, in the norm of K, or by what angle; the worse of the two.
enum class Turn {
  kSlow,   ///< up to 15 %, 0.5 rad
  kStiff,  ///< the explicit velocity is too far off, and could feed energy: docs/theory.md eq. (31)
  kWild,   ///< beyond 50 %, 1 rad: no velocity holds for the whole step
};

/// `gyroscopic_change`: of the twist x over `duration` [s], in body axes.
Turn classifyTurn(const BodyModel& model, const Vector6& gyroscopic_change, const Vector6& x,
                  double duration) noexcept;

/// Change of velocity over one step that the constraint rows are solved against, docs/theory.md eq.
/// (28): the acceleration at the start pose times the duration; implicit midpoint of the body-frame
/// equations where the turn is stiff, and no turning part where it is wild. Rows must not see the
/// velocity at the end of free flight: a pendulum would gain energy. Result in world axes: angular
/// and linear velocity change of the centre of mass [rad/s, m/s].
struct RowVelocity {
  Twist change_W;
  /// The part of it by gyroscopic terms and by the turn of the body axes, which do no work.
  Twist turning_W;
  Turn turn = Turn::kSlow;
  FlightCount count;
};
RowVelocity computeRowVelocity(const FlightTask& task, const RigidState& start) noexcept;

}  // namespace ambient
