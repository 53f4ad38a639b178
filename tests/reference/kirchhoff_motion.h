#pragma once

#include <Eigen/Core>
#include <cmath>

#include "tests/reference/ellipsoid_added_mass.h"

namespace ambient::reference {

// Closed solutions of Kirchhoff's equations without loads for a body with three planes of symmetry:
// total translational inertias M [kg] and rotational inertias I [kg m^2] along its axes, no
// coupling. Lamb, Hydrodynamics, 6th ed., art. 124 to 128.

/// Motion in the plane of the axes x and y with a constant momentum P [kg m/s]; theta is the angle
/// of the axis y from P. theta'' = -Omega^2 sin(theta) cos(theta).
struct PlanarMotion {
  double frequency;  ///< Omega = P sqrt((M_y - M_x) / (M_x M_y I_z)) [rad/s], M_y > M_x

  static PlanarMotion of(const Eigen::Vector3d& masses, double moment_z, double momentum) {
    return {momentum * std::sqrt((masses.y() - masses.x()) / (masses.x() * masses.y() * moment_z))};
  }
  /// Rocking with the amplitude theta_0 < pi/2, released at rest at t = 0.
  double rockingPeriod(double amplitude) const {
    return 4 * completeEllipticK(std::sin(amplitude)) / frequency;
  }
  double rockingAngle(double amplitude, double time) const {
    const double k = std::sin(amplitude);
    return std::asin(k * jacobiElliptic(frequency * time + completeEllipticK(k), k).sn);
  }
  /// Time of half a turn of a body that passes theta = 0 with theta' = `rate` > Omega [rad/s].
  double tumblingHalfTurn(double rate) const {
    return 2 * completeEllipticK(frequency / rate) / rate;
  }
};

/// Munk's moment: lambda^2 [1/s^2] of theta'' = lambda^2 theta for a small turn about the axis k.
/// The body moves along the axis i with speed V; j is the third axis.
struct TranslationAlongAxis {
  Eigen::Vector3d masses, moments;
  double speed;

  double growth(int i, int k) const {
    const int j = 3 - i - k;
    const double momentum = masses[i] * speed;
    return momentum * momentum * (1 / masses[i] - 1 / masses[j]) / moments[k];
  }
};

/// Least stable spin [rad/s] of a body of revolution that moves along its axis with momentum P.
/// Axis moment I3, cross moment I1, inertia C along and A across the axis.
inline double leastStableSpin(double I1, double I3, double C, double A, double P) {
  return 2 * P / I3 * std::sqrt(I1 * (1 / C - 1 / A));
}

/// lambda of the steady screw motion w = lambda p with p in the plane of the axes i and j: lambda^2
/// = (1/M_i - 1/M_j) / (I_i - I_j).
inline double permanentScrew(double M_i, double M_j, double I_i, double I_j) {
  return std::sqrt((1 / M_i - 1 / M_j) / (I_i - I_j));
}

}  // namespace ambient::reference
