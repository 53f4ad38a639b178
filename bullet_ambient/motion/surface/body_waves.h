#pragma once

#include <array>

#include "bullet_ambient/motion/surface/wave_memory.h"
#include "bullet_ambient/spatial/spatial_vectors.h"

namespace ambient {

/// A motion of the body that buoyancy acts against like a spring, and the oscillator that stands
/// for the waves that it makes: G, a, b of docs/theory.md eq. (69).
struct FloatingMode {
  Vector6 motion = Vector6::Zero();  ///< N: the velocity of the motion is N.x for a twist x
  double strength = 0;               ///< G [N/m, N m]
  double loss = 0, rate = 0;         ///< a, b [1/s]
  double stiffness = 0;              ///< k: rho g A_w for heave [N/m], rho g V GM_i for tilt [N m]
  double second_moment =
      0;  ///< I_i: second moment of the waterplane about the axis of the tilt [m^4]; heave: 0
};

/// Heave of the waterplane's centroid, then tilt about its two principal axes; eq. (69), (70). All
/// zero without a waterplane.
using FloatingModes = std::array<FloatingMode, 3>;

/// Returns K + duration^2/4 sum N k N^T over the modes with stiffness k > 0; docs/theory.md eq.
/// (68).
Matrix6 stiffened(const Matrix6& inertia, const FloatingModes& modes, double duration) noexcept;

/// Lets the waves that a body has made and the body act on each other for `duration` [s]. First
/// converts `waves` to the present modes, which never adds energy; eq. (72). Then integrates eq.
/// (71): the sum of x.K x / 2 and the energy of the waves does not grow, whatever the duration. x:
/// twist in B; `to_world`: B to W. @return the twist afterwards; `waves` is updated
Vector6 exchangeWaves(const FloatingModes& modes, const Matrix3& to_world,
                      const Matrix6& inverse_inertia, double duration, const Vector6& x,
                      WaveMemory& waves) noexcept;

/// Returns the mean wrench of the waves on the body, in B, while their states change evenly from
/// `before` to `after`; eq. (70).
Wrench waveWrench(const FloatingModes& modes, const Matrix3& to_world, const WaveMemory& before,
                  const WaveMemory& after) noexcept;

}  // namespace ambient
