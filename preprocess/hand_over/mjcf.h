#pragma once

#include "bullet_ambient/spatial/vector_types.h"
#include "preprocess/hand_over/handed_body.h"

namespace ambient {

/// Computes the semi-axes [m] of the ellipsoid with given added masses against translation along
/// its axes, per unit density [m^3]. Any three positive added masses belong to exactly one
/// ellipsoid. One below 1e-5 of the largest, as of a sheet, is raised to that.
Vector3 semiAxesOf(const Vector3& added_mass);

/// Ellipsoid whose added mass approximates a given one.
struct EllipsoidFit {
  Vector3 semi_axes{0, 0, 0};          ///< [m]
  Vector3 centre{0, 0, 0};             ///< [m]
  Matrix3 axes = Matrix3::Identity();  ///< axes of the ellipsoid, as columns
};

/// Fits an ellipsoid to an added mass per unit density. Axes and sizes follow from the translation
/// block. The centre is where rotation and translation couple least (sum of squares); where that
/// leaves a choice, as for sheets, nearest to `middle` [m].
EllipsoidFit fitEllipsoid(const Matrix6& added_mass, const Vector3& middle);

/// MuJoCo's coefficients of quadratic drag, the first three of fluidcoef. Its drag at a speed v
/// along an axis k of an ellipsoid and its torque at w about it are
///
///   rho v^2 (blunt A_k + slender (A_max - A_k)),  rho w^2 (angular I_k + slender (I_max - I_k))
///
/// with the silhouette A_k along the axis and I_k = 8/15 pi a_k max(a_i, a_j)^4.
struct EllipsoidDrag {
  double blunt = 0.5, slender = 0.25, angular = 1.5;  ///< defaults: MuJoCo's
};

/// Computes MuJoCo's drag at 1 m/s along the axes of the ellipsoid [N] and its torque at 1 rad/s
/// about them [N m], in a fluid of density 1 kg/m^3; rotation first.
Vector6 unitDrag(const EllipsoidDrag& drag, const Vector3& semi_axes);

/// Computes the same of a body by the form law without friction, averaged over both directions.
Vector6 unitDrag(const HandedBody& body, const EllipsoidFit& fit);

/// Fits coefficients >= 0 to such drags: least squares of the differences, each relative to its
/// drag or to 1 % of the largest.
EllipsoidDrag fitDrag(const Vector6& unit_drag, const Vector3& semi_axes);

}  // namespace ambient
