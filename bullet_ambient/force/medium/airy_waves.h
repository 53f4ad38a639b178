#pragma once

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

}  // namespace ambient
