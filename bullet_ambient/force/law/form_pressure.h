#pragma once

#include "bullet_ambient/fluid_body/form_factors.h"

namespace ambient {

// Pressure of the form law, docs/theory.md eq. (43) and (44). The code serves numbers and vectors
// of numbers with the same roundings: the same bits everywhere.

/// |u| as eq. (43) sees it on a slender body: u_n + |t_m|^2/(|u| + u_n), with the squared slip
/// across the body's axis, |t_m|^2. On the windward side only; elsewhere any finite number, 0 where
/// |u| + u_n is 0, at rest and where the face moves straight away from the fluid.
template <class Real>
inline Real speedAcross(const Real& normal_speed, const Real& slip_across_sq, const Real& speed) {
  const Real zero = {}, sum = speed + normal_speed;
  const Real across_sq = slip_across_sq > zero ? slip_across_sq : zero;
  const Real across = normal_speed + across_sq / sum;
  return sum > zero ? across : zero;
}

/// Windward part of q of eq. (43), 0 on the lee side; the pressure is -rho/2 q. `normal_speed` is
/// n.u, the velocity into the fluid; `speed` is |u| [m/s].
template <class Real>
inline Real windwardPressure(const Real& normal_speed, const Real& speed,
                             const FormFactors<Real>& factors) {
  const Real zero = {};
  const Real pressure =
      normal_speed * (factors.by_normal * normal_speed + factors.by_speed * speed);
  return normal_speed > zero ? pressure : zero;
}

/// Complete q of eq. (43): windwardPressure() on the windward side, suction on the lee side.
template <class Real>
inline Real formPressure(const Real& normal_speed, const Real& speed,
                         const FormFactors<Real>& factors) {
  return windwardPressure(normal_speed, speed, factors) -
         (factors.by_lee * normal_speed) * normal_speed;
}

}  // namespace ambient
