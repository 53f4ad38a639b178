#pragma once

#include <algorithm>
#include <cmath>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"

namespace ambient {

/// Inertia of the fluid in a closed box as it resists turning, per mass, docs/theory.md eq. (133)
/// [m^2].
/// @param a,b squares of the sides across the axis [m^2]
inline double boxTurning(double a, double b) noexcept {
  constexpr double kPi5 = kPi * kPi * kPi * kPi * kPi;
  const double ratio = std::sqrt(std::max(a, b) / std::min(a, b));
  const double decay = portable::exp(-kPi * ratio);
  const double tanh = (1 - decay) / (1 + decay);  // of half of that
  const double part = 1 + ratio * ratio;
  const double share =
      std::isfinite(ratio) ? 1 - 4 / part + 768 / kPi5 * (tanh + 0.0045) / (ratio * part) : 1;
  return (a + b) / 12 * share;
}

}  // namespace ambient
