#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cmath>

namespace ambient::reference {

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
