#pragma once

#include <array>
#include <cmath>

namespace ambient::reference {

/// Complete elliptic integral of the first kind K(k) for the modulus 0 <= k < 1, by the
/// arithmetic-geometric mean.
inline double completeEllipticK(double k) {
  double a = 1;
  double b = std::sqrt((1 - k) * (1 + k));
  for (int i = 0; i < 12; ++i) {
    const double mean = (a + b) / 2;
    b = std::sqrt(a * b);
    a = mean;
  }
  return std::acos(-1.0) / (2 * a);
}

/// Jacobi's elliptic functions at u for the modulus 0 <= k < 1.
struct JacobiElliptic {
  double sn, cn, dn;
};

/// Descending Landen transformation, Abramowitz and Stegun 16.4.
inline JacobiElliptic jacobiElliptic(double u, double k) {
  constexpr int kSteps = 12;
  std::array<double, kSteps + 1> a{}, c{};
  a[0] = 1;
  c[0] = k;
  double b = std::sqrt((1 - k) * (1 + k));
  for (int i = 0; i < kSteps; ++i) {
    a[i + 1] = (a[i] + b) / 2;
    c[i + 1] = (a[i] - b) / 2;
    b = std::sqrt(a[i] * b);
  }
  double phi = std::ldexp(a[kSteps] * u, kSteps);
  for (int i = kSteps; i > 0; --i) phi = (phi + std::asin(c[i] / a[i] * std::sin(phi))) / 2;
  const double sn = std::sin(phi);
  return {sn, std::cos(phi), std::sqrt((1 - k * sn) * (1 + k * sn))};
}

}  // namespace ambient::reference
