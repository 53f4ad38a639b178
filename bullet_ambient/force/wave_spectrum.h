#pragma once

#include <cstdint>
#include <vector>

#include "bullet_ambient/force/airy_waves.h"

namespace ambient {

/// A sea that wind has raised: how the energy of its waves is spread over their frequencies by
/// JONSWAP (Hasselmann et al. 1973), docs/theory.md eq. (82).
struct WaveSpectrum {
  double significant_height = 0;  ///< H_s, four times the standard deviation of the height [m]
  double peak_period = 1;         ///< T_p, of the frequency with most energy [s]
  double peak_enhancement = 3.3;  ///< gamma; 1: a fully developed sea (Pierson and Moskowitz 1964)
  Vector3 direction{1, 0, 0};     ///< in which all of them run
  int components = 50;
  std::uint64_t seed = 1;  ///< of the phases; the same on every machine
};

/// Waves of equal amplitude whose frequencies divide the energy of the spectrum into equal parts,
/// each at the median of its part, with random phases: no period of the whole. For AiryWaves.
/// Cost: O(components) and some 0.2 ms.
/// @throws std::invalid_argument, naming value and limit.
std::vector<WaveComponent> wavesOf(const WaveSpectrum& spectrum);

}  // namespace ambient
