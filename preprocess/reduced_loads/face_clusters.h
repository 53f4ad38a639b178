#pragma once

#include <vector>

#include "bullet_ambient/fluid_body/fluid_body.h"

namespace ambient {

/// Indices of faces, cluster by cluster; none is empty.
using FaceClusters = std::vector<std::vector<std::size_t>>;

/// At most `count` clusters of faces that are alike in normal and place: k-means on (n, c) with
/// weights sqrt(A), started from the faces that are farthest from each other. Deterministic. Faces
/// whose other means cannot have come nearer than their own one keep it (Hamerly 2010, from
/// memory). Centroids in units of the body's size. @pre 0 < count <= faces.size().
FaceClusters clusterFaces(const FaceTable& faces, int count);

}  // namespace ambient
