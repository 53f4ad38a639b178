#pragma once

#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// Added mass per unit density of a box about its centre, rotation first, on its axes. Extrapolated
/// from two meshes graded towards the edges, of 3 and 5 times equal divisions and up to some 10 000
/// triangles. Half sizes [m]; cost: some ten seconds of one core.
Vector6 solveBoxFlow(const Vector3& half_sizes);

}  // namespace ambient
