#pragma once

#include <cstdint>
#include <vector>

#include "bullet_ambient/force/medium/water_surface.h"

namespace ambient {

/// One wave of a sea on deep water.
struct WaveComponent {
  double amplitude = 0;        ///< half the height from trough to crest [m]
  double period = 1;           ///< in the frame of the current [s]
  Vector3 direction{1, 0, 0};  ///< propagation; only the horizontal part counts, of any length
  double phase = 0;            ///< theta at the origin of W at time 0; 0: crest [rad]
};

/// Water without waves.
struct CalmSea {
  double level = 0;          ///< up . x of the surface at rest, for unit `up` [m]
  Vector3 up{0, 0, 1};       ///< direction against gravity, of any length > 0
  double gravity = 9.81;     ///< [m/s^2]
  Vector3 current{0, 0, 0};  ///< carries the waves; only the horizontal part counts [m/s]
};

/// A sum of waves of small slope on deep water; theta = k d.x - omega t + phase, k = omega^2 / g,
/// d the direction, z <= 0 the height over the mean level:
///
///   height a cos(theta),  velocity a omega e^(k z) (d cos(theta) + up sin(theta))
///
/// Above the mean level the velocity is that at the mean level.
class AiryWaves final : public WaterSurface {
 public:
  /// @throws std::invalid_argument, naming wave, value and limit, if a number is not physical.
  AiryWaves(const CalmSea& sea, const std::vector<WaveComponent>& components);

  /// Cost: O(waves), a sine, a cosine and an exponential each.
  WaterSample sample(const Vector3& point_W, double time) const noexcept override;
  Vector3 up() const noexcept override { return calm_.up(); }
  /// Root of the mean of k^2, weighted by the energies a^2 of the waves [1/m]; 0: there are none.
  double waveNumber() const noexcept override { return wave_number_; }

 private:
  struct Wave {
    double amplitude, frequency, phase;  ///< [m], [rad/s], [rad]
    double wave_number;                  ///< [1/m]
    Vector3 direction;                   ///< unit, horizontal
  };

  StillWater calm_;
  Vector3 current_;
  std::vector<Wave> waves_;
  double wave_number_ = 0;
};

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
