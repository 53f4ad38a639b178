#pragma once

#include "bullet_ambient/motion/body_model.h"

namespace ambient {

/// A surface load F and the twist it was evaluated at, both in B, as 6-vectors.
struct LoadSample {
  Vector6 twist;
  Vector6 wrench;
};

/// The twist after `duration` [s] under a load that is homogeneous of degree two in the twist,
/// docs/theory.md eq. (23). In the norm of K the drag is the exact quadratic decay and the lift an
/// exact rotation: the energy cannot grow, whatever the duration. A load with positive power at its
/// sample acts as if it had none.
Vector6 passiveKick(const BodyModel& model, const Vector6& x, const LoadSample& load,
                    double duration) noexcept;

}  // namespace ambient
