#pragma once

#include <cmath>

namespace ambient::reference {

/// Pressure coefficients of a flat plate of zero thickness, on its one-sided area and 1/2 rho V^2.
struct PlateCoefficients {
  double normal = 0;  ///< against the windward normal
  double lift = 0;    ///< across the velocity, away from the windward side
  double drag = 0;
};

/// Plate at incidence i in (0, pi/2], no rotation. The windward side carries C_N = cos^2(i); the
/// lee side stays attached, and cancels it, while i <= alpha - pi/2. The centre of pressure is the
/// centroid.
inline PlateCoefficients plateAtIncidence(double incidence, double alpha) {
  const double right_angle = std::acos(0.0);
  if (incidence <= alpha - right_angle) return {};
  const double normal = std::cos(incidence) * std::cos(incidence);
  return {normal, normal * std::cos(incidence), normal * std::sin(incidence)};
}

/// Torque against a slow turn about a diameter of a disk of radius a [m] that slides edge-on at
/// speed V [m/s], alpha = pi/2: 1/2 rho V^2 4/3 a^3 [N m] at any rate of turn.
inline double slidingDiskDamping(double density, double speed, double radius) {
  return 0.5 * density * speed * speed * 4.0 / 3 * std::pow(radius, 3);
}

}  // namespace ambient::reference
