#pragma once

#include "bullet_ambient/force/medium/pool_sides.h"

namespace ambient {

/// Returns the share of a face that is between the sides of a pool, by its centroid [m], unit
/// normal and the squared radius of a disc with its area [m^2]; docs/theory.md eq. (59) at each
/// side.
double shareInPool(const PoolSides& sides, const Vector3& centroid, const Vector3& normal,
                   double radius_sq) noexcept;

}  // namespace ambient
