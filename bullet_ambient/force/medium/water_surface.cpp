#include "bullet_ambient/force/medium/water_surface.h"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace ambient {

StillWater::StillWater(double level, const Vector3& up) : level_(level), up_(up.normalized()) {
  if (!std::isfinite(level)) throw std::invalid_argument("the level of the water is not finite");
  if (!(up.norm() > 0) || !up.allFinite())
    throw std::invalid_argument("the direction up of the water has no length, or is not finite");
}

WaterSample StillWater::sample(const Vector3& point_W, double) const noexcept {
  return {level_ - up_.dot(point_W), {0, 0, 0}, {0, 0, 0}};
}

WaterSurfaceFunction::WaterSurfaceFunction(Function function) : function_(std::move(function)) {
  if (!function_) throw std::invalid_argument("the function of the water's surface is empty");
}

WaterSample WaterSurfaceFunction::sample(const Vector3& point_W, double time) const noexcept {
  try {
    return function_(point_W, time);
  } catch (...) {
    return {std::numeric_limits<double>::quiet_NaN(), {0, 0, 0}, {0, 0, 0}};
  }
}

}  // namespace ambient
