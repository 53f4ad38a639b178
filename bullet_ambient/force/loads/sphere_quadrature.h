#pragma once

#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// Integrals over a smooth sphere that spins, for one separation angle; docs/theory.md eq. (40)
/// to (42). Units: the radius and V + W, with V the speed of the centre and W = R |w|. A vector is
/// stored as its factors of e = v / V, a = w / |w| - (e.w / |w|) e, and
/// b = e x a.
struct SphereIntegrals {
  Vector3 detached;         ///< int |t|^2 n over the detached surface
  Vector3 friction_force;   ///< int |t|^(4/5) t over the attached surface
  Vector3 friction_torque;  ///< int n x |t|^(4/5) t over the attached surface
};

/// Computes one node of a SphereTable. Quadrature over longitude about the velocity: equal steps;
/// over latitude: Gauss's rule between the points of separation. Measured error 1e-5.
SphereIntegrals integrateSphere(double spin_share, double cosine,
                                double separation_cosine) noexcept;

}  // namespace ambient
