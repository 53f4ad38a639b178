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
  FlightCount count;
};
RowVelocity computeRowVelocity(const FlightTask& task, const RigidState& start) noexcept;

}  // namespace ambient
