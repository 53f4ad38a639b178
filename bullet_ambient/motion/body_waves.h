#pragma once

#include <array>

#include "bullet_ambient/force/hydrostatics.h"
#include "bullet_ambient/motion/wave_memory.h"

namespace ambient {

/// What the waves of a body depend on, in B.
struct WaveSource {
  const WetVolume& wet;
  const SurfacePlane& plane;
  double heave_inertia;  ///< added mass along the normal per unit density, times c [m^3]
  double damping;        ///< factor on the waves
};

/// A velocity of the body that the buoyancy acts against.
struct RestoringMode {
  Vector6 motion = Vector6::Zero();  ///< N: the velocity is N.x
  double stiffness = 0;              ///< rho g A_w, rho g V GM_i [N/m, N m]
  double second_moment = 0;          ///< of the waterplane about the axis of a tilt, I_i [m^4]
};

/// Heave of the waterplane's centroid, and tilt about its two principal axes. All zero without a
/// waterplane.
using RestoringModes = std::array<RestoringMode, 3>;
RestoringModes restoringModesOf(const WetVolume& wet, const SurfacePlane& plane) noexcept;

/// One oscillator behind a velocity of the body: G, a, b of eq. (69).
struct WaveMode {
  Vector6 motion = Vector6::Zero();  ///< N
  double strength = 0;               ///< G [N/m, N m]
  double loss = 0, rate = 0;         ///< a, b [1/s]
};

struct WaveModes {
  WaveMode heave, tilt[2];
};

/// Eq. (69), (70), with the modes of that waterplane. All zero without one.
WaveModes waveModesOf(const WaveSource& source, const RestoringModes& restoring) noexcept;

/// Brings the waves to the present modes: they lose energy, or keep it; eq. (72). `to_world`: B to
/// W.
void meetModes(const WaveModes& modes, const Matrix3& to_world, WaveMemory& waves) noexcept;

/// Twist and waves after a time [s], eq. (71): x.K x / 2 and the energy of the waves together do
/// not grow, whatever the time. The waves have met the modes.
Vector6 exchangeWaves(const WaveModes& modes, const Matrix3& to_world,
                      const Matrix6& inverse_inertia, double duration, const Vector6& x,
                      WaveMemory& waves) noexcept;

}  // namespace ambient
