#pragma once

#include <cstdint>

#include "bullet_ambient/force/medium/fluid_region.h"

namespace ambient {

/// Gusts by Dryden's spectra in the form of MIL-F-8785C, docs/theory.md eq. (175): those of
/// MIL-HDBK-1797 are the same functions, with half of the length across the wind.
struct DrydenGusts {
  double height = 10;    ///< over the ground, at least 3.048 (10 ft) [m]
  double speed = 10;     ///< V at which they pass: airspeed, or the wind where a body hovers [m/s]
  double intensity = 1;  ///< sigma_w, vertical; near the ground a tenth of the wind at 6 m [m/s]
  Vector3 direction{1, 0, 0};  ///< of the longitudinal part, which the wind blows along
  Vector3 up{0, 0, 1};         ///< against gravity, of any length
  std::uint64_t seed = 1;
};

/// Lengths [m] and standard deviations [m/s] along the wind, across it and up.
struct DrydenScales {
  Vector3 lengths{0, 0, 0}, intensities{0, 0, 0};
};
/// Returns them at the height of gusts, docs/theory.md eq. (176).
DrydenScales drydenScales(const DrydenGusts& gusts);

/// Makes gusts that blow everywhere at once, a function of the time alone: a sum of some thirty
/// modes, eq. (177). Any step and any start give the same gusts. Cost: two sines and cosines, and
/// some thirty instructions for each mode.
/// @throws std::invalid_argument, naming value and limit, if a number is not physical.
FlowField drydenGusts(const DrydenGusts& gusts);

/// Gusts whose correlation is exp(-t / time) in each axis, those of a first-order Gauss-Markov
/// process: Dryden's along the wind, docs/theory.md eq. (175), without height and speed.
struct GaussMarkovGusts {
  Vector3 intensity{0, 0, 0};  ///< sigma, axes of the world [m/s]
  double time = 1;             ///< in which they forget themselves [s]
  std::uint64_t seed = 1;
};

/// Makes gusts that blow everywhere at once, a function of the time alone, as drydenGusts() does.
/// @throws std::invalid_argument, naming value and limit, if a number is not physical.
FlowField gaussMarkovGusts(const GaussMarkovGusts& gusts);

/// Turbulence in space and time, the same in all directions, with von Karman's spectrum;
/// docs/theory.md eq. (178).
struct Turbulence {
  double length = 100;       ///< L, integral scale along the velocity [m]
  double intensity = 1;      ///< sigma of each component [m/s]
  double smallest = 0;       ///< wavelength at which the spectrum ends [m]; 0: L/94
  Vector3 carried{0, 0, 0};  ///< velocity that carries it along [m/s]; 0: frozen in space
  std::uint64_t seed = 1;
};

/// Makes a field of 64 waves without divergence: the turbulence alone, without the mean velocity
/// that carries it along. Any step and any start give the same field. Cost: 16 sines and cosines,
/// and some thirty instructions for each wave.
/// @throws std::invalid_argument, naming value and limit, if a number is not physical.
FlowField turbulence(const Turbulence& turbulence);

}  // namespace ambient
