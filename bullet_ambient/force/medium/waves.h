#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// State of the water at a point and time, undisturbed by bodies. World axes.
struct WaterSample {
  double height = 0;          ///< surface above the point, vertically [m]; < 0: the point is dry
  Vector3 velocity{0, 0, 0};  ///< [m/s]
  Vector3 acceleration{0, 0, 0};  ///< acceleration of the water particle at the point [m/s^2]
};

/// Prescribed surface of water: bodies do not change it. Derive from this class for another sea,
/// or use WaterSurfaceFunction.
class WaterSurface {
 public:
  virtual ~WaterSurface() = default;

  /// Samples the water at a point above or below the surface; time [s]. Called from all threads
  /// that move bodies, for each body in each step: must neither write nor allocate.
  virtual WaterSample sample(const Vector3& point_W, double time) const noexcept = 0;
  /// True if the surface never moves: bodies may then fall asleep.
  virtual bool isStill() const noexcept { return false; }
  /// Wave number k that the surface bends with [1/m]: a body of length L with k L <= 0.3 samples it
  /// at one point, a longer one along its length; docs/theory.md eq. (83). Default: 0 where the
  /// surface never moves, else infinite.
  virtual double waveNumber() const noexcept {
    return isStill() ? 0 : std::numeric_limits<double>::infinity();
  }
  /// Direction against gravity that heights are measured along, unit; zero: any.
  virtual Vector3 up() const noexcept { return Vector3::Zero(); }
};

/// Horizontal plane at rest.
class StillWater final : public WaterSurface {
 public:
  /// Plane up . x = level [m], with unit `up`; `up` points against gravity and may have any length.
  /// @throws std::invalid_argument if a number is not finite, or `up` has no direction.
  StillWater(double level, const Vector3& up);

  WaterSample sample(const Vector3& point_W, double) const noexcept override;
  bool isStill() const noexcept override { return true; }
  Vector3 up() const noexcept override { return up_; }

 private:
  double level_;  ///< [m]
  Vector3 up_;    ///< unit
};

/// Water surface given by a function of place and time. The rules of WaterSurface::sample() apply.
/// An exception of the function counts as a sample that is not finite.
class WaterSurfaceFunction final : public WaterSurface {
 public:
  using Function = std::function<WaterSample(const Vector3& point_W, double time)>;

  /// @throws std::invalid_argument if the function is empty.
  explicit WaterSurfaceFunction(Function function);
  WaterSample sample(const Vector3& point_W, double time) const noexcept override;

 private:
  Function function_;
};

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
