#pragma once

#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// Closes cracks: where a vertex of one triangle lies on an edge of another one, within the
/// tolerance [m], the other one is divided there, until every edge has a partner or nothing helps.
/// Only edges without a partner are looked at. Cost O(T log T + E V) for E such edges with V ends
/// between their own, in x.
TriangleMesh withoutCracks(const TriangleMesh& mesh, double tolerance);

}  // namespace ambient
