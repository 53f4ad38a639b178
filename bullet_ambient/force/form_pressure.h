#pragma once

#include "bullet_ambient/fluid_body/form_factors.h"

namespace ambient {

// The pressure of the form law, docs/theory.md eq. (43) and (44). Alike on numbers and vectors of
// them, in one sequence of roundings: the same bits everywhere.

/// q of a pressure rho/2 q on a face, less what the lee side adds to it: from its velocity into the
/// fluid and all of its speed.
template <class Real>
inline Real windwardPressure(const Real& normal_speed, const Real& speed,
                             const FormFactors<Real>& factors) {
  const Real zero = {};
  const Real pressure =
      normal_speed * (factors.by_normal * normal_speed + factors.by_speed * speed);
  return normal_speed > zero ? pressure : zero;
}

/// All of q.
template <class Real>
inline Real formPressure(const Real& normal_speed, const Real& speed,
                         const FormFactors<Real>& factors) {
  return windwardPressure(normal_speed, speed, factors) -
         (factors.by_lee * normal_speed) * normal_speed;
}

}  // namespace ambient
