#pragma once

#include "bullet_ambient/fluid_body/form_factors.h"

namespace ambient {

// The pressure of the form law, docs/theory.md eq. (43) and (44). Alike on numbers and vectors of
// them, in one sequence of roundings: the same bits everywhere.

/// q of a pressure rho/2 q on a face: from its velocity into the fluid and all of its speed.
/// `Number`: float or double.
template <class Number, class Real>
inline Real formPressure(const Real& normal_speed, const Real& speed,
                         const FormFactors<Real>& factors) {
  const Real zero = {};
  const Real magnitude = normal_speed > zero ? normal_speed : -normal_speed;
  const Real drag = normal_speed > zero ? zero + static_cast<Number>(kWindwardDrag)
                                        : zero + static_cast<Number>(kLeeDrag);
  return (drag * normal_speed) * (factors.by_normal * magnitude + factors.by_speed * speed);
}

}  // namespace ambient
