#pragma once

#include "bullet_ambient/motion/dual_pair.h"

namespace ambient {

/// The twist that a surface load was evaluated at, with its momentum, and the load F as a wrench,
/// with the acceleration K^-1 F; all in B.
struct LoadSample {
  DualPair motion;
  DualPair load;
};

/// The motion x after `duration` [s] under a load that is homogeneous of degree two in the twist,
/// docs/theory.md eq. (23). In the norm of K the drag is the exact quadratic decay and the lift an
/// exact rotation: the energy cannot grow, whatever the duration. A load with positive power at its
/// sample acts as if it had none.
DualPair passiveKick(const DualPair& x, const LoadSample& sample, double duration) noexcept;

}  // namespace ambient
