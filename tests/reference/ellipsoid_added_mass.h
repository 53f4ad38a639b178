#pragma once

#include <Eigen/Core>
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

}  // namespace ambient::reference
