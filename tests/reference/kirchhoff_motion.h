#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
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

/// Pose and momenta of a body in an ideal fluid: orientation (x, y, z, w; body to world), position
/// in world axes, angular and linear momentum in body axes.
using KirchhoffState = Eigen::Matrix<double, 13, 1>;

inline Eigen::Quaterniond orientationOf(const KirchhoffState& s) {
  return Eigen::Quaterniond(s[3], s[0], s[1], s[2]);
}

/// Kirchhoff's equations in body axes with a constant wrench (torque, force) in body axes:
/// l' = l x w + p x v + torque, p' = p x w + force, (w, v) = K^-1 (l, p).
struct KirchhoffEquations {
  Eigen::Matrix<double, 6, 6> inverse_inertia;
  Eigen::Matrix<double, 6, 1> wrench = Eigen::Matrix<double, 6, 1>::Zero();

  KirchhoffState operator()(const KirchhoffState& s) const {
    const Eigen::Vector3d l = s.segment<3>(7), p = s.tail<3>();
    const Eigen::Matrix<double, 6, 1> x = inverse_inertia * s.tail<6>();
    const Eigen::Vector3d w = x.head<3>(), v = x.tail<3>();
    const Eigen::Quaterniond q = orientationOf(s);
    KirchhoffState rate;
    rate.head<4>() = 0.5 * (q * Eigen::Quaterniond(0, w.x(), w.y(), w.z())).coeffs();
    rate.segment<3>(4) = q.normalized() * v;
    rate.segment<3>(7) = l.cross(w) + p.cross(v) + wrench.head<3>();
    rate.tail<3>() = p.cross(w) + wrench.tail<3>();
    return rate;
  }
};

/// Gragg's modified midpoint rule, extrapolated over 2, 4, ..., 16 inner steps: order 16 in the
/// length of a step. Independent of the integrators under test in scheme and in unknowns.
inline KirchhoffState integrate(const KirchhoffEquations& equations, KirchhoffState s,
                                double duration, int steps) {
  constexpr int kColumns = 8;
  const double h = duration / steps;
  for (int step = 0; step < steps; ++step) {
    std::array<KirchhoffState, kColumns> table;
    for (int row = 0; row < kColumns; ++row) {
      const int n = 2 * (row + 1);
      KirchhoffState before = s, now = s + h / n * equations(s);
      for (int i = 1; i < n; ++i) {
        const KirchhoffState next = before + 2 * h / n * equations(now);
        before = now;
        now = next;
      }
      KirchhoffState value = 0.5 * (now + before + h / n * equations(now));
      for (int column = 0; column < row; ++column) {  // Neville's scheme in h^2, in place
        const double ratio = static_cast<double>(row + 1) / (row - column);
        const KirchhoffState refined = value + (value - table[column]) / (ratio * ratio - 1);
        table[column] = value;
        value = refined;
      }
      table[row] = value;
    }
    s = table[kColumns - 1];
    s.head<4>().normalize();
  }
  return s;
}

}  // namespace ambient::reference
