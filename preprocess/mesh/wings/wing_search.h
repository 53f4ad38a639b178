#pragma once

#include <cstdint>
#include <vector>

#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// Finds thin parts that stand off a body: wings, fins, blades; docs/wings.md. Random points, the
/// same in every call. Cost: some 40 000 rays, 0.1 s.
/// @param mesh a closed body
/// @returns labels of its triangles, 0 or the number of a wing from 1 on: all 1 if one that is not
/// joined is most of the body; none if there are no wings, or more than kMostFoundWings
std::vector<std::uint8_t> findWings(const TriangleMesh& mesh);

/// With more thin parts than these, such as the fins of a heat sink, none counts as a wing.
constexpr int kMostFoundWings = 12;

}  // namespace ambient
