#pragma once

#include "preprocess/hand_over/ellipsoid_fit.h"
#include "preprocess/hand_over/handed_body.h"

namespace ambient {

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
