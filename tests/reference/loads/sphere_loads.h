#pragma once

#include <cmath>
#include <vector>

namespace ambient::reference {

// Loads of the model on a smooth sphere, in closed form. Coefficients on pi R^2 and 1/2 rho V^2.
// alpha is the separation angle. Pressure has no torque. S = w R / V with the spin w perpendicular
// to the velocity V; lift acts along w x v.

struct DragAndLift {
  double drag = 0;
  double lift = 0;
};

/// C_D = sin^4(alpha) / 2: faces at polar angle theta < alpha from the velocity carry
/// -1/2 rho V^2 sin^2(theta) along their normals.
inline double sphereDragCoefficient(double alpha) { return std::pow(std::sin(alpha), 4) / 2; }

/// alpha = pi/2: the spin adds nothing to n.v, so the windward half stays attached.
inline DragAndLift spinningSphereAtRightAngle(double S) {
  return {0.5 + 0.75 * S * S, 4.0 / 3 * S};
}

/// alpha > pi/2 and S >= 1 / |cos(alpha)|: flow attached everywhere; front and back pressures
/// cancel.
inline DragAndLift fullyAttachedSpinningSphere(double S) { return {0, 8.0 / 3 * S}; }

/// Coefficients of a sphere at a separation angle over pi/2 and a spin.
struct SpinningSphere {
  double angle, S, drag, lift;
};

/// Semi-analytic one-dimensional integrals over the smooth sphere, uncertainty 1e-9, and closed
/// forms.
inline std::vector<SpinningSphere> spinningSpheres() {
  std::vector<SpinningSphere> spheres{{1.2, 0.05, 0.41030868939497217, 0.10924556955800413},
                                      {1.2, 0.2, 0.4288841794950287, 0.43817804761101437},
                                      {1.2, 0.3, 0.4535413294905215, 0.659658610174517},
                                      {1.2, 0.75, 0.680247184574195, 1.7056466285939358},
                                      {1.2, 1, 0.8797399046128874, 2.3439487185667836},
                                      {1.2, 2, 1.9440341791417017, 5.442007597625046},
                                      {1.5, 0.1, 0.12499882616636354, 0.26888423014766705},
                                      {1.5, 0.2, 0.12498112357472242, 0.5379010428168065},
                                      {1.5, 0.5, 0.12423471792022862, 1.347072801167785},
                                      {1.5, 1, 0.11048543456039825, 2.7107184175196286}};
  for (const double S : {0.0, 0.05, 0.1, 0.3, 0.5, 1.0, 2.0, 50.0})
    spheres.push_back(
        {1, S, spinningSphereAtRightAngle(S).drag, spinningSphereAtRightAngle(S).lift});
  for (const double S : {2.0, 3.0})
    spheres.push_back({1.5, S, 0, fullyAttachedSpinningSphere(S).lift});
  for (const double angle : {1.01, 1.1, 1.2, 1.3, 1.4, 1.5, 1.7, 1.8, 1.9, 2.0})
    spheres.push_back({angle, 0, sphereDragCoefficient(angle * std::acos(-1.0) / 2), 0});
  return spheres;
}

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
