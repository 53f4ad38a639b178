#pragma once

#include <vector>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/fluid_body/fluid_body.h"

namespace ambient {

/// Least and largest number of clusters of a level: from one block of the kernel to where the sum
/// over all faces of usual meshes is cheaper.
constexpr int kFewestClusters = 16, kMostClusters = 1024;

/// Makes reduced levels of a shape's loads at a separation angle [rad], one per number of clusters,
/// with their errors; docs/theory.md section "Reduced loads". A level does not get more clusters
/// than there are faces. The same bits on every run. Cost: about 1 s for 200 clusters, growing with
/// the square of the clusters and with the faces.
/// @throws std::invalid_argument, naming body, value and limit, for a number of clusters out of
/// range, an angle outside [pi/2, pi] or a body without faces that have an area.
std::vector<LoadLevel> buildLoadLevels(const FluidBody& body, const std::vector<int>& clusters,
                                       double separation_angle = kPi / 2);

}  // namespace ambient
