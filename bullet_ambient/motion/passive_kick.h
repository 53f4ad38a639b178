#pragma once

#include "bullet_ambient/motion/dual_pair.h"

namespace ambient {

/// The twist that a surface load was evaluated at, with its momentum, and the load F as a wrench,
/// with the acceleration K^-1 F; all in B.
struct LoadSample {
  DualPair motion;
  DualPair load;
};

/// The motion under a load that is homogeneous of degree two in the twist, docs/theory.md eq. (23):
///
///   x' = Rot(theta) x / (1 + z),  z = d h |x| / n,  theta = h (|a| / n) (|x| / n) ln(1 + z) / z
///
///   x, x'  twist before and after `duration` h [s]
///   K      total inertia; |x| = sqrt(x.K x) is the norm of a twist in it [sqrt(J)]
///   y, F   twist and load of the sample; n = |y|
///   d      drag, -F.y / n^2 [1/s]; where F feeds energy at its sample: 0
///   a      lift, what K^-1 F has across y: K^-1 F = -d y + a with y.K a = 0
///   Rot    rotation by theta in the plane of y and a, orthogonal in the norm of K
///
/// Drag is the exact quadratic decay and lift an exact rotation: |x'| <= |x|, whatever the
/// duration.
DualPair passiveKick(const DualPair& x, const LoadSample& sample, double duration) noexcept;

}  // namespace ambient
