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

}  // namespace ambient::reference
