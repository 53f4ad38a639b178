#pragma once

#include <Eigen/Core>
#include <cmath>

namespace ambient::reference {

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
