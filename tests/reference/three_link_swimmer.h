#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <functional>

namespace ambient::reference {

/// Three equal links in a row, joined by two hinges, in a plane of ideal fluid at rest. Added mass
/// of each link alone: no hydrodynamic interaction.
struct ThreeLinkSwimmer {
  double along = 0;   ///< mass of a link with fluid, along its axis [kg]
  double across = 0;  ///< mass of a link with fluid, across its axis [kg]
  double moment = 0;  ///< moment of inertia with fluid, about its centre [kg m^2]
  double arm = 0;     ///< distance from the centre of a link to a hinge [m]
};

/// Angles of front link and rear link relative to the middle one, and their rates.
struct SwimmerShape {
  Eigen::Vector2d angles, rates;
};

/// Velocity (forward, left, turning) of the middle link at zero momentum of swimmer and fluid: the
/// connection of Kanso, Marsden, Rowley and Melli-Huber 2005.
inline Eigen::Vector3d velocityWithoutMomentum(const ThreeLinkSwimmer& s,
                                               const SwimmerShape& shape) {
  Eigen::Matrix3d locked = Eigen::Vector3d(s.along, s.across, s.moment).asDiagonal();
  Eigen::Vector3d of_rates = Eigen::Vector3d::Zero();
  for (int i = 0; i < 2; ++i) {
    const double side = i == 0 ? 1 : -1;  // front link: +arm, rear link: -arm
    const double c = std::cos(shape.angles[i]), n = std::sin(shape.angles[i]);
    // Velocity of the link's centre in its own axes, from (u, v, r) of the middle link: the hinge
    // moves with (u, v + side arm r); the centre adds side arm (r + rate) across the link.
    Eigen::Matrix3d J;
    J << c, n, n * side * s.arm, -n, c, c * side * s.arm + side * s.arm, 0, 0, 1;
    const Eigen::Vector3d by_rate(0, side * s.arm, 1);
    const Eigen::DiagonalMatrix<double, 3> inertia(s.along, s.across, s.moment);
    locked += J.transpose() * inertia * J;
    of_rates += J.transpose() * (inertia * by_rate) * shape.rates[i];
  }
  const Eigen::Vector3d b = -of_rates;
  // Cramer's rule needs Eigen/Core alone.
  const auto det = [](const Eigen::Matrix3d& m) {
    return m(0, 0) * (m(1, 1) * m(2, 2) - m(1, 2) * m(2, 1)) -
           m(0, 1) * (m(1, 0) * m(2, 2) - m(1, 2) * m(2, 0)) +
           m(0, 2) * (m(1, 0) * m(2, 1) - m(1, 1) * m(2, 0));
  };
  Eigen::Vector3d x;
  for (int k = 0; k < 3; ++k) {
    Eigen::Matrix3d replaced = locked;
    replaced.col(k) = b;
    x[k] = det(replaced) / det(locked);
  }
  return x;
}

/// Integrates place (x, y) and direction of the middle link from the origin, by the classical
/// Runge-Kutta rule; returns them at the end of the time.
inline Eigen::Vector3d swim(const ThreeLinkSwimmer& s,
                            const std::function<SwimmerShape(double)>& shape_at, double time,
                            int steps) {
  const auto rate = [&](double t, const Eigen::Vector3d& at) {
    const Eigen::Vector3d v = velocityWithoutMomentum(s, shape_at(t));
    const double c = std::cos(at[2]), n = std::sin(at[2]);
    return Eigen::Vector3d(c * v[0] - n * v[1], n * v[0] + c * v[1], v[2]);
  };
  Eigen::Vector3d at = Eigen::Vector3d::Zero();
  const double h = time / steps;
  for (int i = 0; i < steps; ++i) {
    const double t = i * h;
    const Eigen::Vector3d k1 = rate(t, at), k2 = rate(t + h / 2, at + h / 2 * k1),
                          k3 = rate(t + h / 2, at + h / 2 * k2), k4 = rate(t + h, at + h * k3);
    at += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  }
  return at;
}

}  // namespace ambient::reference
