#pragma once

#include "bullet_ambient/motion/body_model.h"
#include "bullet_ambient/motion/rigid_state.h"

namespace ambient {

/// Precision of flowWithoutLoads() at which what remains is rounding.
constexpr double kToRounding = 1e-16;

struct Flow {
  RigidState state;        ///< at the end
  bool is_precise = true;  ///< false: the turn was too long, a cruder rest of the way was taken
};

/// Motion of the body and the fluid for `duration` [s] without loads, docs/theory.md eq. (22):
/// energy, world momentum and angular momentum stay, up to `precision` relative to the motion, and
/// the energy never grows. One body of FlightKernel::flow.
Flow flowWithoutLoads(const BodyModel& model, const RigidState& state, double duration,
                      double precision = kToRounding) noexcept;

}  // namespace ambient
