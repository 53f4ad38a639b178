#pragma once

#include <cmath>

namespace ambient::reference {

// Skin friction of the published law on a smooth sphere, in closed form; alpha: separation angle.

/// int_0^b sin^3.8, by Simpson's rule; off by less than 1e-12.
inline double integralOfSine38(double b) {
  constexpr int kSteps = 4000;
  const double h = b / kSteps;
  const auto f = [](double angle) { return std::pow(std::sin(angle), 3.8); };
  double sum = 0;
  for (int i = 0; i < kSteps; ++i)
    sum += h / 6 * (f(i * h) + 4 * f((i + 0.5) * h) + f((i + 1) * h));
  return sum;
}

/// Radius of a sphere and properties of the fluid around it.
struct SphereInFluid {
  double radius = 0;     ///< R [m]
  double density = 0;    ///< rho [kg/m^3]
  double viscosity = 0;  ///< mu [Pa s]

  /// 1/2 rho C_f |u_s|^(1/5): 1/2 rho 0.0576 (rho L / mu)^(-1/5), L = sqrt(4 pi) R.
  double frictionScale() const {
    const double length = std::sqrt(4 * std::acos(-1.0)) * radius;
    return 0.5 * density * 0.0576 * std::pow(density * length / viscosity, -0.2);
  }
};

/// Skin-friction drag at speed V [m/s] without spin [N]: |u_s| = V sin(theta) on theta < alpha,
/// along the flow with another sin(theta).
inline double sphereFrictionDrag(const SphereInFluid& s, double speed, double alpha) {
  return s.frictionScale() * std::pow(speed, 1.8) * 2 * std::acos(-1.0) * s.radius * s.radius *
         integralOfSine38(alpha);
}

/// Skin-friction torque that brakes a sphere spinning at w [rad/s] in place, alpha > pi/2 [N m]:
/// |u_s| = w R sin(theta) everywhere, with the arm R sin(theta).
inline double sphereFrictionTorque(const SphereInFluid& s, double spin) {
  return s.frictionScale() * std::pow(spin * s.radius, 1.8) * 2 * std::acos(-1.0) *
         std::pow(s.radius, 3) * integralOfSine38(std::acos(-1.0));
}

/// Drag coefficient on pi b^2 of a smooth spheroid that moves along its axis, alpha = pi/2:
/// C_D = 1 - (1 + k) (1/k - ln(1 + k) / k^2), k = b^2/a^2 - 1, semi-axis a along the axis, b
/// across.
/// @pre a != b
inline double spheroidDragCoefficient(double a, double b) {
  const double k = b * b / (a * a) - 1;
  return 1 - (1 + k) * (1 / k - std::log1p(k) / (k * k));
}

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
