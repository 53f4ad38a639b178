#pragma once

#include <functional>

#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// Water at a point and time, undisturbed by bodies. World axes.
struct WaterSample {
  double height = 0;  ///< of the surface above the point, vertically [m]; < 0: the point is dry
  Vector3 velocity{0, 0, 0};      ///< [m/s]
  Vector3 acceleration{0, 0, 0};  ///< of the water that is there [m/s^2]
};

/// A surface of water that is given: bodies do not change it. Derive from it for a sea of your own,
/// or use WaterSurfaceFunction.
class WaterSurface {
 public:
  virtual ~WaterSurface() = default;

  /// At a point above or below it. Called from every thread that moves a body, for each body in
  /// each step: it must neither write nor allocate.
  virtual WaterSample sample(const Vector3& point_W, double time) const noexcept = 0;
  /// Whether it never moves: bodies may then fall asleep in it.
  virtual bool isStill() const noexcept { return false; }
};

/// A plane that rests.
class StillWater final : public WaterSurface {
 public:
  /// The plane up . x = level; `up`: against gravity, of any length > 0.
  /// @throws std::invalid_argument if a number is not finite, or `up` has no direction.
  StillWater(double level, const Vector3& up);

  WaterSample sample(const Vector3& point_W, double) const noexcept override;
  bool isStill() const noexcept override { return true; }
  const Vector3& up() const noexcept { return up_; }

 private:
  double level_;  ///< [m]
  Vector3 up_;    ///< unit
};

/// Any function of place and time; WaterSurface::sample() says what it may do. What it throws is
/// taken for a sample that is not finite.
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
