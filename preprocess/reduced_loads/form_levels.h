#pragma once

#include <optional>
#include <vector>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// Least and largest number of faces of a level: from one block of the kernel to where the sum over
/// all faces of usual meshes is cheaper.
constexpr int kFewestLevelFaces = 16, kMostLevelFaces = 1024;

/// Makes reduced faces for the form law: one level per number in `faces` that is below the number
/// of faces of the full sum; docs/theory.md eq. (51a). Each cluster of faces with similar normal
/// and place becomes one face, which only takes energy, as its faces do; areas are fitted to the
/// loads. Mirror symmetries of the body along the axes of F are kept, and so is that of a body of
/// revolution about one of them: pressure then has no moment about it. The same bits on every run.
/// Cost: 10 us per face.
/// @throws std::invalid_argument naming the body, if no faces that are apart have an area, and as
/// formLawFaces().
std::vector<FormLevel> buildFormLevels(const FluidBody& body, const std::vector<int>& faces);

/// Finds the smallest level of up to 256 faces whose error is at most `p99_error`; none if no level
/// with fewer faces than the full sum reaches that. Cost: 30 us per face. @throws as
/// buildFormLevels().
std::optional<FormLevel> smallestFormLevel(const FluidBody& body, double p99_error);

}  // namespace ambient
