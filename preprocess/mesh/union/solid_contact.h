#pragma once

#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// Least gap between two solids, over the size of the smaller one [1]. The flow through narrower
/// gaps is not resolved.
constexpr double kLeastGap = 1e-3;

/// True if two closed surfaces cross, one lies inside the other, or a vertex of one is closer to
/// the other than kLeastGap. Cost O(T1 T2) if their bounding boxes meet.
bool areInContact(const TriangleMesh& a, const TriangleMesh& b);

}  // namespace ambient
