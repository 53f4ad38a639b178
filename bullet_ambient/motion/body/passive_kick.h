#pragma once

#include "bullet_ambient/motion/body/dual_pair.h"

namespace ambient {

/// Sample of a surface load: the twist y it was evaluated at, with K y, and the load F, with
/// K^-1 F; all in B.
struct LoadSample {
  DualPair motion;
  DualPair load;
};

/// Motion after `duration` under a load homogeneous of degree 2 in the twist, docs/theory.md
/// eq. (23):
///
///   x' = Rot(theta) x / (1 + z),  z = d h |x| / n,  theta = h (|a| / n) (|x| / n) ln(1 + z) / z
///
///   x, x'  twist before and after `duration` h [s]
///   K      total inertia; |x| = sqrt(x.K x) is the norm of a twist in it [sqrt(J)]
///   y, F   twist and load of the sample; n = |y|
///   d      drag, max(-F.y / n^2, 0) [1/s]: 0 if F feeds energy at the sample
///   a      lift: K^-1 F = -d y + a with y.K a = 0
///   Rot    rotation by theta in the plane of y and a, orthogonal in the norm of K
///
/// Drag is an exact quadratic decay and lift an exact rotation: |x'| <= |x| for any duration.
DualPair passiveKick(const DualPair& x, const LoadSample& sample, double duration) noexcept;

}  // namespace ambient
