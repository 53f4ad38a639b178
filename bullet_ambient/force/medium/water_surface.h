#pragma once

#include <functional>
#include <limits>

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

}  // namespace ambient
