#pragma once

#include <cstdint>
#include <vector>

#include "bullet_ambient/force/medium/airy_waves.h"

namespace ambient {

/// JONSWAP spectrum of a wind sea: energy of the waves over frequency (Hasselmann et al. 1973),
/// docs/theory.md eq. (82).
struct WaveSpectrum {
  double significant_height = 0;  ///< H_s, four times the standard deviation of the height [m]
  double peak_period = 1;         ///< T_p, period at the maximum of the spectrum [s]
  double peak_enhancement = 3.3;  ///< gamma; 1: a fully developed sea (Pierson and Moskowitz 1964)
  Vector3 direction{1, 0, 0};     ///< direction of propagation of all waves
  int components = 50;            ///< number of waves
  std::uint64_t seed = 1;         ///< seed of the random phases; same phases on every machine
};

/// Makes the waves of a spectrum, for AiryWaves. Divides the spectrum into parts of equal energy;
/// each part gives one wave at its median frequency. Amplitudes are equal, phases random: the sum
/// has no period. Cost: O(components) and some 0.2 ms.
/// @throws std::invalid_argument, naming value and limit, if a number is not physical.
std::vector<WaveComponent> wavesOf(const WaveSpectrum& spectrum);

}  // namespace ambient
