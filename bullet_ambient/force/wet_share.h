#pragma once

namespace ambient {
namespace {

/// Share of a face in the fluid, docs/theory.md eq. (59), in lanes; for kernels, as
/// form_pressure.h. `depth`: of its barycentre; `cosine`: n.s; `radius_sq`: of a disc of its area,
/// which the face is taken for.
template <class Lanes, class Root>
inline Lanes wetShareOf(Lanes depth, Lanes cosine, Lanes radius_sq, const Root& root) {
  constexpr float kLeastTilt = 1e-4f;     // squared sine: a face flat on the surface gets wet in a
                                          // hundredth of its radius
  constexpr float kLeastSquare = 1e-30f;  // of faces without area
  const Lanes zero = {}, one = zero + 1.0f;
  const Lanes reach_sq = radius_sq * (one + kLeastTilt - cosine * cosine) + kLeastSquare;
  const Lanes share = 0.5f + 0.5f * (depth / root(reach_sq));
  const Lanes positive = share > zero ? share : zero;
  return positive < one ? positive : one;
}

}  // namespace
}  // namespace ambient
