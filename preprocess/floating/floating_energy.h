#pragma once

#include "bullet_ambient/fluid_body/packed/packed_hull.h"
#include "bullet_ambient/force/surface/hydrostatics.h"
#include "preprocess/floating/floating_body.h"

namespace ambient {

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
struct FloatingPose {
  SurfacePlane plane;
  WetVolume wet;
  double energy = 0;                    ///< E [J]
  Vector3 gradient{0, 0, 0};            ///< of E by s, in the plane [J]
  Matrix3 stiffness = Matrix3::Zero();  ///< second derivative of E by s, in the plane [J]
};

/// @pre 0 < mass < density times the volume of the hull.
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

}  // namespace ambient
