#pragma once

#include <array>
#include <memory>
#include <string>
#include <utility>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/force/loads/surface_loads.h"

namespace ambient {

/// Computes the area of the body's silhouette along an axis [m^2]: what stands in the way of the
/// flow, once where parts stand behind each other. Exact to 1e-3. Cost: some ms.
double frontalArea(const FluidBody& body, const Vector3& axis);

/// Sets body.drag from drag coefficients that were measured along the axes of F, on the frontal
/// areas.
void setMeasuredDrag(const Vector3& coefficients, FluidBody& body);

/// Surface loads on a fluid body, as in a world by default, but in double precision. Twists and
/// wrenches in F.
class BodyLoads {
 public:
  BodyLoads(const std::shared_ptr<const FluidBody>& body, const Medium& medium,
            const FlowSettings& flow);
  BodyLoads(FluidBody body, const Medium& medium, const FlowSettings& flow)
      : BodyLoads(std::make_shared<const FluidBody>(std::move(body)), medium, flow) {}

  /// Computes the loads about the origin of F, for a twist relative to the fluid. NaN if its power
  /// is beyond the largest number, or its Reynolds number beyond 1e60.
  FaceLoads at(const Twist& relative_twist) const;
  /// Computes minus the derivative of all loads by the twist, by differences of 1e-4 of the speed,
  /// rotation first. Cost: 12 evaluations. @pre the body moves, and does not only turn
  Matrix6 dampingAt(const Twist& relative_twist) const;

 private:
  bool isKnownAt(const Twist& relative_twist) const;

  std::shared_ptr<const SurfaceLoads> loads_;  ///< null: none
  FrameOffset frame_;                          ///< pose in F of the frame of the loads
  double density_ = 0, viscosity_ = 0;         ///< viscosity 0: the law has no Reynolds number
  double diameter_ = 0;                        ///< D_A [m]
};

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
