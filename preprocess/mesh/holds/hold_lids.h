#pragma once

#include <string>
#include <vector>

#include "preprocess/mesh/holds/hold_labels.h"
#include "preprocess/mesh/holds/vessel.h"
#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// Spans lids across the borders of labelled triangles: the closed mesh and the holds.
/// @param labels of the triangles, as labelTriangles() makes them
/// @param name begins lines about holds that are left out since their lids or walls do not close
Vessel spanLids(const TriangleMesh& mesh, const TriangleNeighbours& neighbours,
                std::vector<int> labels, const std::string& name);

}  // namespace ambient
