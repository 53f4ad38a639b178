#pragma once

namespace ambient {
namespace {

/// Share of a face's area in the fluid, docs/theory.md eq. (59), per lane; for kernels. `depth`:
/// zeta of the barycentre; `cosine`: n.s; `radius_sq`: squared radius of the disc with the area of
/// the face; `root`: square root of lanes. All lengths in one unit.
template <class Lanes, class Root>
inline Lanes wetShareOf(Lanes depth, Lanes cosine, Lanes radius_sq, const Root& root) {
  constexpr float kLeastTilt = 1e-4f;     // 10^-4 of eq. (59): a face parallel to the surface gets
                                          // wet over a hundredth of its radius
  constexpr float kLeastSquare = 1e-30f;  // avoids 0 / 0 for faces without area
  const Lanes zero = {}, one = zero + 1.0f;
  const Lanes reach_sq = radius_sq * (one + kLeastTilt - cosine * cosine) + kLeastSquare;
  const Lanes share = 0.5f + 0.5f * (depth / root(reach_sq));
  const Lanes positive = share > zero ? share : zero;
  return positive < one ? positive : one;
}

}  // namespace
}  // namespace ambient
