#pragma once

#include <array>

#include "bullet_ambient/motion/surface/wave_memory.h"

namespace ambient {

/// A velocity of the body that the buoyancy acts against.
struct RestoringMode {
  Vector6 motion = Vector6::Zero();  ///< N: the velocity is N.x
  double stiffness = 0;              ///< rho g A_w, rho g V GM_i [N/m, N m]
  double second_moment = 0;          ///< of the waterplane about the axis of a tilt, I_i [m^4]
};

/// Heave of the waterplane's centroid, and tilt about its two principal axes. All zero without a
/// waterplane.
using RestoringModes = std::array<RestoringMode, 3>;

/// K + duration^2/4 N k N^T over the stiffnesses k > 0.
Matrix6 stiffened(const Matrix6& inertia, const RestoringModes& modes, double duration) noexcept;

/// One oscillator behind a velocity of the body: G, a, b of eq. (69).
struct WaveMode {
  Vector6 motion = Vector6::Zero();  ///< N
  double strength = 0;               ///< G [N/m, N m]
  double loss = 0, rate = 0;         ///< a, b [1/s]
};

/// Eq. (69), (70). All zero without a waterplane.
struct WaveModes {
  WaveMode heave, tilt[2];
};

/// Brings the waves to the present modes: they lose energy, or keep it; eq. (72). Then lets waves
/// and body act on each other for a time [s], eq. (71): x.K x / 2 and the energy of the waves
/// together do not grow, whatever the time. `to_world`: B to W. @return the twist; `waves` is
/// brought along
Vector6 exchangeWaves(const WaveModes& modes, const Matrix3& to_world,
                      const Matrix6& inverse_inertia, double duration, const Vector6& x,
                      WaveMemory& waves) noexcept;

/// Wrench in B of waves whose states change evenly from `before` to `after`, eq. (70), mean over
/// the time.
Wrench waveWrench(const WaveModes& modes, const Matrix3& to_world, const WaveMemory& before,
                  const WaveMemory& after) noexcept;

}  // namespace ambient
