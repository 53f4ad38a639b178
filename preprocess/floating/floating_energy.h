#pragma once

#include "bullet_ambient/fluid_body/packed/packed_hull.h"
#include "preprocess/floating/floating_body.h"

namespace ambient {

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
