#pragma once

#include <cmath>

namespace ambient::reference {

/// Sphere released at rest in a still fluid with constant drag coefficient: (m + m_f/2) v' = (m -
/// m_f) g - 1/2 rho pi R^2 C_D v |v|, v downwards. Light spheres rise: v < 0.
struct SphereFall {
  double mass, radius, density, gravity;
  double drag_coefficient = 0.5;

  static double pi() { return std::acos(-1.0); }
  double displacedMass() const { return density * 4 / 3 * pi() * radius * radius * radius; }
  double effectiveMass() const { return mass + displacedMass() / 2; }
  /// [m/s^2], downwards
  double firstAcceleration() const { return gravity * (mass - displacedMass()) / effectiveMass(); }
  double terminalSpeed() const {
    return std::sqrt(2 * std::abs(mass - displacedMass()) * gravity /
                     (density * pi() * radius * radius * drag_coefficient));
  }
  double settlingTime() const { return terminalSpeed() / std::abs(firstAcceleration()); }
  double velocity(double time) const {
    return std::copysign(terminalSpeed() * std::tanh(time / settlingTime()), firstAcceleration());
  }
  double distance(double time) const {
    return std::copysign(
        terminalSpeed() * settlingTime() * std::log(std::cosh(time / settlingTime())),
        firstAcceleration());
  }
};

}  // namespace ambient::reference
