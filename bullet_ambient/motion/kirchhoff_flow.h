#pragma once

#include "bullet_ambient/motion/body_model.h"
#include "bullet_ambient/motion/rigid_state.h"

namespace ambient {

/// Motion of the body and the fluid for `duration` [s] without loads, docs/theory.md eq. (22):
/// energy, world momentum and angular momentum stay, to rounding. Power series of as many terms as
/// are needed for that; a body that turns by more than about 30 rad gets a cruder rest of the way
/// that keeps the momenta and cannot gain energy. Cost: 0.4 us for small turns, some us per radian.
RigidState flowWithoutLoads(const BodyModel& model, const RigidState& state,
                            double duration) noexcept;

}  // namespace ambient
