#pragma once

#include "bullet_ambient/force/surface/hydrostatics.h"

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

}  // namespace ambient
