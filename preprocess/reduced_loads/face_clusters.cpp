#include "preprocess/reduced_loads/face_clusters.h"

#include <cmath>
#include <limits>

#include "bullet_ambient/base/ambient_assert.h"

namespace ambient {
namespace {

constexpr int kRounds = 30;

using Features = std::vector<Vector6>;

Features featuresOf(const FaceTable& faces) {
  Features features(faces.size());
  for (std::size_t i = 0; i < faces.size(); ++i) features[i] << faces.normal(i), faces.centroid(i);
  return features;
}

std::size_t largestFace(const FaceTable& faces) {
  std::size_t largest = 0;
  for (std::size_t i = 1; i < faces.size(); ++i)
    if (faces.area[i] > faces.area[largest]) largest = i;
  return largest;
}

Features farthestFirst(const FaceTable& faces, const Features& features, int count) {
  Features seeds{features[largestFace(faces)]};
  std::vector<double> distance(features.size(), std::numeric_limits<double>::infinity());
  while (static_cast<int>(seeds.size()) < count) {
    std::size_t farthest = 0;
    for (std::size_t i = 0; i < features.size(); ++i) {
      distance[i] = std::min(distance[i], (features[i] - seeds.back()).squaredNorm());
      if (faces.area[i] > 0 && distance[i] > distance[farthest]) farthest = i;
    }
    if (!(distance[farthest] > 0)) break;
    seeds.push_back(features[farthest]);
  }
  return seeds;
}

std::size_t nearest(const Features& means, const Vector6& feature) {
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < means.size(); ++k) {
    const double distance = (means[k] - feature).squaredNorm();
    if (distance < least) {
      least = distance;
      best = k;
    }
  }
  return best;
}

void moveToMeans(const FaceTable& faces, const Features& features,
                 const std::vector<std::size_t>& owner, Features& means) {
  Features sums(means.size(), Vector6::Zero());
  std::vector<double> weights(means.size(), 0);
  for (std::size_t i = 0; i < features.size(); ++i) {
    const double weight = std::sqrt(faces.area[i]);
    sums[owner[i]] += weight * features[i];
    weights[owner[i]] += weight;
  }
  for (std::size_t k = 0; k < means.size(); ++k)
    if (weights[k] > 0) means[k] = sums[k] / weights[k];
}

}  // namespace

FaceClusters clusterFaces(const FaceTable& faces, int count) {
  AMBIENT_ASSERT(count > 0 && static_cast<std::size_t>(count) <= faces.size());
  const Features features = featuresOf(faces);
  Features means = farthestFirst(faces, features, count);
  std::vector<std::size_t> owner(features.size(), 0);
  for (int round = 0; round < kRounds; ++round) {
    bool changed = round == 0;
    for (std::size_t i = 0; i < features.size(); ++i) {
      const std::size_t now = nearest(means, features[i]);
      changed |= now != owner[i];
      owner[i] = now;
    }
    if (!changed) break;
    moveToMeans(faces, features, owner, means);
  }
  FaceClusters clusters(means.size());
  for (std::size_t i = 0; i < features.size(); ++i)
    if (faces.area[i] > 0) clusters[owner[i]].push_back(i);
  FaceClusters kept;
  for (std::vector<std::size_t>& cluster : clusters)
    if (!cluster.empty()) kept.push_back(std::move(cluster));
  return kept;
}

}  // namespace ambient
