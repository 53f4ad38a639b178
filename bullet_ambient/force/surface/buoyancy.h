#pragma once

#include "bullet_ambient/spatial/spatial_vectors.h"

namespace ambient {

/// Buoyancy of a submerged body: force -m_f g at the centre of volume, docs/theory.md eq. (18).
/// `displaced_mass` m_f = rho V [kg]; `centre_of_volume` [m] and `gravity` [m/s^2] in one frame.
/// The wrench is in the same frame. In a fluid that accelerates by a, pass g - a as
/// gravity, eq. (19).
inline Wrench buoyancy(double displaced_mass, const Vector3& centre_of_volume,
                       const Vector3& gravity) noexcept {
  return Wrench::ofForceAt(-displaced_mass * gravity, centre_of_volume);
}

/// Weight m_b g [N] at the centre of mass, which is the frame's origin: no torque. Gravity does not
/// act on the added mass.
inline Wrench weight(double mass, const Vector3& gravity) noexcept {
  return {Vector3::Zero(), mass * gravity};
}

}  // namespace ambient
