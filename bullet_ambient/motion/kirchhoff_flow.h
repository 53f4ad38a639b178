#pragma once

#include "bullet_ambient/motion/body_model.h"
#include "bullet_ambient/motion/rigid_state.h"

namespace ambient {

/// Precision of flowWithoutLoads() at which what remains is rounding.
constexpr double kToRounding = 1e-16;

/// Pose and motion of a body, its twist with its momentum.
struct MomentumState {
  Quaternion orientation;  ///< B to W, unit
  Vector3 position;        ///< of B's origin in W [m]
  DualPair motion;         ///< in B

  static MomentumState of(const BodyModel& model, const RigidState& state) {
    return {state.orientation, state.position, pairOfTwist(model, state.twist.vector())};
  }
  RigidState rigidState() const { return {orientation, position, Twist::fromVector(motion.twist)}; }
};

struct Flow {
  MomentumState state;     ///< at the end
  bool is_precise = true;  ///< false: the turn was too long, a cruder rest of the way was taken
};

/// Motion of the body and the fluid for `duration` [s] without loads, docs/theory.md eq. (22):
/// energy, world momentum and angular momentum stay, up to `precision` relative to the motion, and
/// the energy never grows. Power series of as many terms as are needed for that; a body that turns
/// by more than about 500 rad gets a cruder rest of the way that keeps the momenta. Cost: 0.1 us
/// for small turns, some us per radian.
Flow flowWithoutLoads(const BodyModel& model, const MomentumState& state, double duration,
                      double precision = kToRounding) noexcept;

}  // namespace ambient
