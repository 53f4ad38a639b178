#pragma once

namespace ambient {

// The pressure of the form law, docs/theory.md eq. (43) and (44). Alike on numbers and vectors of
// them, in one sequence of roundings: the same bits everywhere.

constexpr double kWindwardDrag = 1.05;                  ///< b, of a flat face
constexpr double kLeeDrag = 0.12;                       ///< e
constexpr double kFlatDrag = kWindwardDrag + kLeeDrag;  ///< c: C_D of a plate broadside
constexpr double kRoundRelief = 1 / kFlatDrag;          ///< gamma: C_D = 1/2 of a sphere

/// q of a pressure rho/2 q on a face: from its velocity into the fluid, all of its speed and its
/// sharpness. `Number`: float or double.
template <class Number, class Real>
inline Real formPressure(const Real& normal_speed, const Real& speed, const Real& sharpness) {
  constexpr auto kGamma = static_cast<Number>(kRoundRelief);
  constexpr auto kFall = static_cast<Number>(1 + kRoundRelief);
  const Real zero = {};
  const Real magnitude = normal_speed > zero ? normal_speed : -normal_speed;
  const Real drag = normal_speed > zero ? zero + static_cast<Number>(kWindwardDrag)
                                        : zero - static_cast<Number>(kLeeDrag);
  const Real h = (kGamma - kFall * sharpness) * magnitude + (sharpness + sharpness) * speed;
  return (drag * magnitude) * h;
}

}  // namespace ambient
