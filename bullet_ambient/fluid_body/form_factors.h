#pragma once

namespace ambient {

// Factors of the form law for the sharpness of a face, docs/theory.md eq. (43) to (45). The code
// serves numbers and vectors of numbers with the same roundings: the same bits everywhere.

constexpr double kWindwardDrag = 1.05;                  ///< b, of a flat face
constexpr double kLeeDrag = 0.12;                       ///< e
constexpr double kFlatDrag = kWindwardDrag + kLeeDrag;  ///< c: C_D of a plate broadside
constexpr double kRoundRelief = 1 / kFlatDrag;          ///< gamma: C_D = 1/2 of a sphere

/// Factors of q = max(u_n, 0) (by_normal u_n + by_speed |u|) - by_lee u_n^2, eq. (43). `Real`:
/// a number or a vector of numbers.
template <class Real>
struct FormFactors {
  Real by_normal, by_speed, by_lee;
};

/// Computes the factors for a sharpness. Above 1, q is the flat face's q times the sharpness.
template <class Number, class Real>
inline FormFactors<Real> formFactors(const Real& sharpness) {
  constexpr auto kC = static_cast<Number>(kFlatDrag);
  constexpr auto kLee = static_cast<Number>(kLeeDrag);
  constexpr auto kGamma = static_cast<Number>(kRoundRelief);
  const Real one = Real{} + static_cast<Number>(1);
  const Real flat = sharpness < one ? sharpness : one;
  const Real gain = sharpness > one ? sharpness : one;
  return {gain * (one - (1 + kC) * flat), gain * ((kC + kC) * flat),
          gain * (kLee * (kGamma + (1 - kGamma) * flat))};
}

}  // namespace ambient
