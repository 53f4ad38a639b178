#pragma once

#include <cmath>

namespace ambient::reference {

/// Drag coefficient on pi b^2 of a smooth spheroid that moves along its axis, alpha = pi/2:
/// C_D = 1 - (1 + k) (1/k - ln(1 + k) / k^2), k = b^2/a^2 - 1, semi-axis a along the axis, b
/// across.
/// @pre a != b
inline double spheroidDragCoefficient(double a, double b) {
  const double k = b * b / (a * a) - 1;
  return 1 - (1 + k) * (1 / k - std::log1p(k) / (k * k));
}

}  // namespace ambient::reference
