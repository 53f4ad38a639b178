#pragma once

#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// Gap between two solids below which the flow through it is not resolved, over the size of the
/// smaller one.
constexpr double kLeastGap = 1e-3;

/// Whether two closed surfaces cross, one lies inside the other, or a vertex of one comes closer to
/// the other than kLeastGap. Cost O(T1 T2) where their bounding boxes meet.
bool areInContact(const TriangleMesh& a, const TriangleMesh& b);

}  // namespace ambient
