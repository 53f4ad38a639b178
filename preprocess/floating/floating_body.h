#pragma once

#include <array>
#include <memory>
#include <vector>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/fluid_body/packed/packed_shape.h"
#include "bullet_ambient/force/surface/hold_shape.h"
#include "bullet_ambient/force/surface/hydrostatics.h"

namespace ambient {

/// Water in a hold of a floating body, which stays there in every attitude.
struct HeldWater {
  HoldShape hold;
  double volume = 0;  ///< [m^3]
};

/// A body on still water; all in frame F.
struct FloatingBody {
  std::shared_ptr<const FluidBody> shape;
  double mass = 0;                    ///< [kg]
  Vector3 centre_of_mass{0, 0, 0};    ///< [m]
  Matrix3 inertia = Matrix3::Zero();  ///< about the centre of mass [kg m^2]
  double density = 998;               ///< of the water [kg/m^3]
  double gravity = 9.81;              ///< [m/s^2]
  std::vector<HeldWater> water = {};  ///< in its holds
};

/// Puts water into the holds of a body: volumes [m^3] in their order.
/// @throws std::invalid_argument, naming value and limit, for more numbers than holds, or a volume
/// outside of its hold.
void setWater(FloatingBody& body, const std::vector<double>& volumes);

/// Metacentric height of a floating body for turns about one axis in the plane of the water.
struct Metacentre {
  Vector3 axis{0, 0, 0};  ///< unit
  double height = 0;      ///< GM, above the centre of mass [m]
};

/// A small oscillation about a floating attitude, without the waves that it makes; the other
/// motions are free.
struct SmallOscillation {
  double period = 0;      ///< [s]; infinite: neutral
  Vector3 turn{0, 0, 0};  ///< unit axis of the rotation; zero: heave alone
  bool is_heave = false;  ///< true: most of its potential energy is that of heave
};

/// Stable floating attitude: a local minimum of the energy.
struct FloatingAttitude {
  Vector3 up{0, 0, 1};  ///< upward normal of the water, in F
  SurfacePlane plane;   ///< surface of the water in F
  WetVolume wet;
  double draught = 0;                     ///< depth of the lowest point [m]
  double height_of_mass = 0;              ///< height of the centre of mass above the surface [m]
  std::array<Metacentre, 2> metacentres;  ///< the smaller height first
  std::array<SmallOscillation, 3> modes;  ///< the longest period first
  double energy = 0;  ///< energy of weight and water [J]; reference: centre of mass at the surface,
                      ///< no water displaced
  double share = 0;   ///< share of all attitudes from which the body comes to this one
  int alike = 1;      ///< number of attitudes of the same energy, equal by symmetry
};

/// Mass of a body [kg] and its centre [m].
struct PointMass {
  double mass = 0;
  Vector3 centre{0, 0, 0};
};

/// Hydrostatic stiffness of a body with weight: second derivative of its potential energy by a
/// small twist about `point` [N m, N; N, N/m], rotation first, in the frame of the plane. With the
/// waterplane A, c, I, the centre of buoyancy b and the centre of mass m, from `point`,
///
///   K = rho g (A q q^T + [s]x I [s]x^T) + rho g V N(b) - m g N(m),
///   q = (c x s, s),  N(r) = s.r - (s r^T + r s^T)/2
///
/// where [s]x I [s]x^T and N stand in the rotation block. N has products of yaw and tilt that
/// cancel for a body in balance.
Matrix6 restoringStiffness(const WetVolume& wet, const SurfacePlane& plane, const PointMass& weight,
                           const Vector3& point);

/// A body that floats at a given attitude, the water's normal s in F:
///
///   E(s) = min_h ( rho g W(s, h) + m g (s.c - h) ),  c the centre of mass
///
/// With water in its holds W, and volume and moment of what is wet, are those of docs/theory.md eq.
/// (135), and the second moments of the water's levels are taken off that of the waterplane (137).
struct FloatingPose {
  SurfacePlane plane;
  WetVolume wet;
  WetVolume outside;                    ///< of the closed body
  double energy = 0;                    ///< E [J]
  Vector3 gradient{0, 0, 0};            ///< of E by s, in the plane [J]
  Matrix3 stiffness = Matrix3::Zero();  ///< second derivative of E by s, in the plane [J]
};

/// @pre 0 < mass with that of the water < density times the volume of the hull.
FloatingPose floatAt(const FloatingBody& body, const PackedHull& hull, const Vector3& up);

/// Descends to a local minimum of the energy near an attitude.
FloatingPose settle(const FloatingBody& body, const PackedHull& hull, const Vector3& up);

/// Describes a floating attitude: draught, metacentres, periods.
FloatingAttitude describe(const FloatingBody& body, const PackedHull& hull,
                          const FloatingPose& pose);

/// Eigenvalues in ascending order, and unit eigenvectors, of a symmetric matrix that maps a plane
/// into itself.
struct PlaneEigen {
  std::array<double, 2> values;
  std::array<Vector3, 2> vectors;
};
PlaneEigen planeEigen(const Matrix3& matrix, const PlaneAxes& axes);

/// Finds all attitudes in which a body floats, largest share first; none if it sinks. Attitudes of
/// equal energy count as one. Method: descents of the energy from some hundred attitudes. Cost: 0.1
/// s for a hull of 1000 triangles.
/// @throws std::invalid_argument, naming value and limit, if mass, inertia, density or gravity are
/// not physical, or the shape has no surface or no volume.
std::vector<FloatingAttitude> findFloatingAttitudes(const FloatingBody& body);

}  // namespace ambient
