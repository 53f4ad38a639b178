#pragma once

#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// Added mass per unit density of a box about its centre, rotation first, on its axes: solved on
/// two meshes graded towards the edges, with 3 and 5 times the same divisions and up to some 10 000
/// triangles, and extrapolated. Half sizes [m]; some ten seconds of one core.
Vector6 solveBoxFlow(const Vector3& half_sizes);

}  // namespace ambient
