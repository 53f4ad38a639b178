#pragma once

#include "bullet_ambient/motion/lanes/surface_lanes.h"
#include "bullet_ambient/motion/surface/symmetric_matrix.h"
#include "bullet_ambient/spatial/spatial_vectors.h"

namespace ambient {

/// Lets the waves that a body has made and the body act on each other for `duration` [s]. First
/// converts `waves` to the present modes, which never adds energy; eq. (72). Then integrates eq.
/// (71): the sum of x.K x / 2 and the energy of the waves does not grow, whatever the duration. x:
/// twist in B; `to_world`: B to W; `inverse_inertia`: K^-1. @return the twist afterwards; `waves`
/// is updated
Vector6 exchangeWaves(const FloatingModes& modes, const Matrix3& to_world,
                      const SymmetricMatrix& inverse_inertia, double duration, const Vector6& x,
                      WaveMemory& waves) noexcept;

/// Returns the mean wrench of the waves on the body, in B, while their states change evenly from
/// `before` to `after`; eq. (70).
Wrench waveWrench(const FloatingModes& modes, const Matrix3& to_world, const WaveMemory& before,
                  const WaveMemory& after) noexcept;

}  // namespace ambient
