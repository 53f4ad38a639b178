#pragma once

#include "bullet_ambient/spatial/spatial_vectors.h"

namespace ambient {

/// Buoyancy, the hydrostatic pressure over the whole surface: -m_f g at the centre of volume;
/// docs/theory.md eq. (18). `displaced_mass` m_f = rho V [kg]; `centre_of_volume` [m] and `gravity`
/// [m/s^2] in one frame, in which the wrench comes out. In a fluid that itself accelerates by a,
/// the pressure is that of g - a.
inline Wrench buoyancy(double displaced_mass, const Vector3& centre_of_volume,
                       const Vector3& gravity) noexcept {
  return Wrench::ofForceAt(-displaced_mass * gravity, centre_of_volume);
}

/// Weight m_b g [N], which acts at the centre of mass: the frame's origin, hence no torque. Gravity
/// never acts on the added mass.
inline Wrench weight(double mass, const Vector3& gravity) noexcept {
  return {Vector3::Zero(), mass * gravity};
}

}  // namespace ambient
