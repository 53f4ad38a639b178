#include "preprocess/reduced_loads/reduced_loads.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "bullet_ambient/base/pi.h"
#include "preprocess/reduced_loads/centred_faces.h"
#include "preprocess/reduced_loads/face_clusters.h"
#include "preprocess/reduced_loads/level_error.h"
#include "preprocess/reduced_loads/level_fit.h"

namespace ambient {
namespace {

constexpr double kRightAngle = kPi / 2;

// One evaluation, in faces that cost as much. Measured by face_loads_benchmark with AVX-512 for 48,
// 96 and 200 clusters: 80, 190, 420 with friction, 280, 385, 640 without.
double costOf(int clusters) { return 100 + 2 * clusters; }

void requireAngle(const FluidBody& body, double angle) {
  if (angle >= kRightAngle * (1 - 1e-9) && angle <= 2 * kRightAngle * (1 + 1e-9)) return;
  throw std::invalid_argument("fluid body '" + body.name + "': levels for a separation angle of " +
                              std::to_string(angle) + ", must be pi/2 to pi");
}

void requireClusters(const FluidBody& body, int clusters) {
  if (clusters >= kFewestClusters && clusters <= kMostClusters) return;
  throw std::invalid_argument("fluid body '" + body.name + "': a level of " +
                              std::to_string(clusters) + " clusters, must be " +
                              std::to_string(kFewestClusters) + " to " +
                              std::to_string(kMostClusters));
}

}  // namespace

std::vector<LoadLevel> buildLoadLevels(const FluidBody& body, const std::vector<int>& clusters,
                                       double separation_angle) {
  requireAngle(body, separation_angle);
  const CentredFaces centred(body, body.faces);
  std::vector<LoadLevel> levels;
  for (const int count : clusters) {
    requireClusters(body, count);
    const std::size_t most = centred.faces.size();
    const int clusters_here = static_cast<int>(std::min<std::size_t>(count, most));
    LoadLevel level =
        fitLevel(centred.faces, clusterFaces(centred.faces, clusters_here), separation_angle);
    level.error = measureError(level, centred.faces);
    level.centre = centred.centre;
    level.length = centred.length;
    level.cost = costOf(level.clusters);
    levels.push_back(std::move(level));
  }
  return levels;
}

}  // namespace ambient
