#pragma once

#include "bullet_ambient/motion/body/body_model.h"
#include "bullet_ambient/motion/flight/flight_task.h"

namespace ambient {

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
