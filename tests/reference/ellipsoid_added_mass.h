#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>

namespace ambient::reference {

/// Carlson's R_D(x, y, z) = 3/2 int_0^inf dt / (sqrt((t+x)(t+y)) (t+z)^(3/2)) by duplication
/// (Carlson 1979), to rounding.
inline double carlsonRd(double x, double y, double z) {
  double sum = 0, factor = 1;
  for (int i = 0; i < 30; ++i) {
    const double lambda = std::sqrt(x * y) + std::sqrt(x * z) + std::sqrt(y * z);
    sum += factor / (std::sqrt(z) * (z + lambda));
    factor /= 4;
    x = (x + lambda) / 4;
    y = (y + lambda) / 4;
    z = (z + lambda) / 4;
  }
  return 3 * sum + factor / (z * std::sqrt(z));
}

/// Added mass per unit density of an ellipsoid about its centre: diagonal (w_x, w_y, w_z, v_x, v_y,
/// v_z), all other entries 0. Semi-axes [m]. Lamb, Hydrodynamics, 6th ed., art. 114 and 115.
inline Eigen::Matrix<double, 6, 1> ellipsoidAddedMass(const Eigen::Vector3d& semi_axes) {
  const Eigen::Array3d q = semi_axes.array().square();
  const double product = semi_axes.prod();
  const double volume = 4.0 / 3.0 * std::acos(-1.0) * product;
  // alpha_0, beta_0, gamma_0: abc int_0^inf dt / ((q_k + t) sqrt(...)).
  Eigen::Array3d shape;
  for (int k = 0; k < 3; ++k)
    shape[k] = product * 2.0 / 3.0 * carlsonRd(q[(k + 1) % 3], q[(k + 2) % 3], q[k]);
  Eigen::Matrix<double, 6, 1> K;
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    const double difference = q[i] - q[j];
    K[k] = difference == 0 ? 0
                           : volume / 5 * difference * difference * (shape[j] - shape[i]) /
                                 (2 * difference + (q[i] + q[j]) * (shape[i] - shape[j]));
    K[k + 3] = volume * shape[k] / (2 - shape[k]);
  }
  return K;
}

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

/// Resistance of an ellipsoid in creeping flow about its centre, per unit viscosity: diagonal
/// (rotations, translations). Semi-axes [m]. Oberbeck 1876, Jeffery 1922; the integrals alpha_i =
/// int_0^inf dl / ((a_i^2 + l) Delta) with Delta^2 = prod (a_k^2 + l) by the trapezoidal rule in t,
/// l = exp(pi/2 sinh t).
inline Eigen::Matrix<double, 6, 1> ellipsoidResistance(const Eigen::Vector3d& a) {
  const double pi = std::acos(-1.0), step = 1.0 / 64;
  Eigen::Vector3d alpha = Eigen::Vector3d::Zero();
  for (int n = -300; n <= 300; ++n) {
    const double t = step * n, l = std::exp(pi / 2 * std::sinh(t)),
                 weight = step * pi / 2 * std::cosh(t) * l;
    if (!(l > 1e-150 && l < 1e60)) continue;
    const Eigen::Array3d sum = a.array().square() + l;
    alpha.array() += weight / (sum * std::sqrt(sum.prod()));
  }
  const Eigen::Vector3d weighted = a.array().square() * alpha.array();
  Eigen::Matrix<double, 6, 1> R;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    R[i] = 16 * pi / 3 * (a[j] * a[j] + a[k] * a[k]) / (weighted[j] + weighted[k]);
    R[3 + i] = 16 * pi / (weighted.sum() + weighted[i]);
  }
  return R;
}

}  // namespace ambient::reference
