#pragma once

#include <cmath>

#include "bullet_ambient/force/law/wet_share.h"
#include "bullet_ambient/force/medium/surface_plane.h"

namespace ambient {
namespace {

/// Returns the share of a face that is between the sides of a pool, by its centroid [m], unit
/// normal and the squared radius of a disc with its area [m^2]; docs/theory.md eq. (59) at each
/// side.
inline double shareInPool(const PoolSides& sides, const Vector3& centroid, const Vector3& normal,
                          double radius_sq) noexcept {
  double share = 1;
  for (int i = 0; i < sides.count; ++i) {
    const PoolSides::Side& side = sides.of[i];
    share *= wetShareOf(side.normal.dot(side.point - centroid), side.normal.dot(normal), radius_sq,
                        [](double x) { return std::sqrt(x); });
  }
  return share;
}

}  // namespace
}  // namespace ambient
