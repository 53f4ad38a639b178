#pragma once

#include <cmath>

namespace ambient::reference {

/// int_0^1 f by the tanh-sinh rule (Takahasi and Mori 1974): to rounding for smooth f, and nearly
/// so with algebraic or logarithmic singularities at the ends. f(x, 1 - x) gets both distances,
/// exact near either end.
template <typename Function>
double integrateTanhSinh(const Function& f, double step = 0.1) {
  const double half_pi = std::acos(-1.0) / 2;
  double sum = 0;
  for (int k = -static_cast<int>(3.2 / step); k * step <= 3.2; ++k) {
    const double t = k * step;
    const double s = half_pi * std::sinh(t);
    const double x = 1 / (1 + std::exp(-2 * s)), y = 1 / (1 + std::exp(2 * s));
    sum += f(x, y) * 2 * half_pi * std::cosh(t) * x * y;
  }
  return sum * step;
}

}  // namespace ambient::reference
