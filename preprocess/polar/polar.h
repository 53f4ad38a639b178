#pragma once

#include <array>
#include <string>

#include "preprocess/polar/body_loads.h"

namespace ambient {

/// Units of coefficients: C_F = F / (1/2 rho V^2 area), C_M = M / (1/2 rho V^2 area
/// length).
struct PolarReference {
  double area = 0;    ///< [m^2]
  double length = 0;  ///< [m]
};

/// Flight of a body through the fluid.
struct PolarFlight {
  Matrix3 axes = Matrix3::Identity();  ///< forward, left and up as columns in F
  double density = 1;                  ///< of the fluid [kg/m^3]
  double speed = 1;                    ///< [m/s]
  PolarReference reference;
  /// Linear block of the added mass over density, in F [m^3]: for Munk's moment, as in a world.
  Matrix3 added_mass = Matrix3::Zero();
};

/// C_L, C_D, C_Y (to the right), C_l, C_m, C_n about F's origin, as a pilot counts them.
using PolarCoefficients = std::array<double, 6>;

/// Returns the axis of F with a name: x, -y, +z.
/// @throws std::invalid_argument for any other text.
Vector3 axisNamed(const std::string& name);

/// @pre the two are perpendicular unit vectors
Matrix3 flightAxes(const Vector3& forward, const Vector3& up);

/// Returns the area of the silhouette along `up` and the extent along `forward`.
PolarReference usualReference(const FluidBody& body, const Matrix3& axes);

/// Computes the coefficients at angles of attack and side-slip [rad]. Cost: one evaluation of the
/// loads.
PolarCoefficients polarCoefficients(const BodyLoads& loads, const PolarFlight& flight,
                                    double attack, double side_slip);

}  // namespace ambient
