#pragma once

#include "bullet_ambient/fluid_body/load_level.h"
#include "preprocess/reduced_loads/face_clusters.h"

namespace ambient {

/// Fits the level of a partition of the faces at a separation angle [rad], in the faces' own units
/// about their origin. The even part is exact; the wrenches of the clusters are a least-squares fit
/// to the loads on all faces over sampled motions. docs/theory.md eq. (36) to (39).
LoadLevel fitLevel(const FaceTable& faces, const FaceClusters& clusters, double separation_angle);

}  // namespace ambient
