#pragma once

#include <array>
#include <vector>

#include "bullet_ambient/fluid_body/blocks.h"
#include "bullet_ambient/fluid_body/fluid_body.h"

namespace ambient {

using HullTriangle = std::array<Vector3, 3>;

/// Returns the symmetry by which a part of the hull of a body may be kept: but for rounding, the
/// image of each triangle of its surface is one of them. None of a hull of few triangles, nor of a
/// body whose added mass has no mirrors. Cost: O(T log T).
HullSymmetry symmetryOf(const FluidBody& body);

/// Returns what is kept: the parts of triangles on the positive side of the axes across that of the
/// symmetry. What rounding leaves beside their planes is on them.
std::vector<HullTriangle> partOf(const std::vector<HullTriangle>& triangles,
                                 const HullSymmetry& symmetry);
/// Returns the corners that are kept.
std::vector<Vector3> partOf(const std::vector<Vector3>& corners, const HullSymmetry& symmetry);

}  // namespace ambient
