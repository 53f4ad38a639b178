#pragma once

#include <optional>
#include <vector>

#include "bullet_ambient/fluid_body/fluid_body.h"

namespace ambient {

/// Reduced faces for the form law, one level per number of faces that is below that of the faces
/// the law is summed over; docs/theory.md eq. (51a). Clusters of faces alike in normal and place
/// become one face each, which takes energy as each of them does; areas are fitted to the loads.
/// Mirrors of the body along the axes of F are kept. The same bits on every run. Cost: 10 us per
/// face.
/// @throws std::invalid_argument as buildLoadLevels() and formLawFaces().
std::vector<FormLevel> buildFormLevels(const FluidBody& body, const std::vector<int>& faces);

/// The smallest level of up to 256 faces whose error is at most `p99_error`; none: there is no such
/// one below the number of all faces. Cost: 30 us per face. @throws as buildFormLevels().
std::optional<FormLevel> smallestFormLevel(const FluidBody& body, double p99_error);

}  // namespace ambient
