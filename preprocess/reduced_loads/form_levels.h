#pragma once

#include <vector>

#include "bullet_ambient/fluid_body/fluid_body.h"

namespace ambient {

/// Reduced faces for the form law, one level per number of clusters that is below that of the faces
/// the law is summed over: a cluster of faces alike in normal and place becomes one face, which
/// takes energy as each of them does. The same bits on every run. Cost: as buildLoadLevels() at
/// most.
/// @throws std::invalid_argument as buildLoadLevels() and formLawFaces().
std::vector<FormLevel> buildFormLevels(const FluidBody& body, const std::vector<int>& clusters);

}  // namespace ambient
