#pragma once

#include "bullet_ambient/force/kernels/lane_vectors.h"

namespace ambient {
namespace {

/// Constants of the form law for lifting and slender shapes, the same in all lanes; zero if
/// motion.wing is null. `Motion`: SingleMotion.
template <class Lanes>
struct WingLanes {
  VectorsOf<Lanes> facing = {}, span = {}, slender = {};
  Lanes pitching_rate = {}, slip_share = {};

  // Inlined: else the vectors pass through memory.
  template <class Motion>
  [[gnu::always_inline]] explicit WingLanes(const Motion& motion) {
    slip_share = slip_share + motion.slip_share;
    if (!motion.wing) return;
    facing = inAllLanes<Lanes>(motion.wing->facing);
    span = inAllLanes<Lanes>(motion.wing->span);
    slender = inAllLanes<Lanes>(motion.wing->slender);
    pitching_rate = pitching_rate + motion.pitching_rate;
  }
};

}  // namespace
}  // namespace ambient
