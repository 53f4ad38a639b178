#pragma once

#include "bullet_ambient/motion/flight.h"

namespace ambient {

/// Change of velocity over one step that the constraint rows are solved against, docs/theory.md eq.
/// (28): the acceleration at the start pose times the duration; implicit midpoint of the body-frame
/// equations where the gyroscopic part is stiff. Rows must not see the velocity at the end of free
/// flight: a pendulum would gain energy. Result in world axes: angular and linear velocity change
/// of the centre of mass [rad/s, m/s].
struct RowVelocity {
  Twist change_W;
  /// The part of it by gyroscopic terms and by the turn of the body axes, which do no work.
  Twist turning_W;
  /// That part is large, so that the step's error could feed energy: docs/theory.md eq. (31).
  bool is_stiff = false;
  FlightCount count;
};
RowVelocity computeRowVelocity(const FlightTask& task, const RigidState& start) noexcept;

}  // namespace ambient
