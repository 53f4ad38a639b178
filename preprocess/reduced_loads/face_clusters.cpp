#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "bullet_ambient/base/ambient_assert.h"
#include "preprocess/reduced_loads/form_levels.h"

namespace ambient {
namespace {

using Features = std::vector<Vector6>;

Features featuresOf(const FaceTable& faces) {
  Features features(faces.size());
  for (std::size_t i = 0; i < faces.size(); ++i) features[i] << faces.normal(i), faces.centroid(i);
  return features;
}

Features farthestFirst(const FaceTable& faces, const Features& features, int count) {
  const auto largest = std::max_element(faces.area.begin(), faces.area.end());
  Features seeds{features[static_cast<std::size_t>(largest - faces.area.begin())]};
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

/// Means of clusters, and of each pair a quarter of its squared distance.
struct Means {
  explicit Means(const Features& of_clusters) : places(of_clusters), quarters(of_clusters.size()) {
    for (std::size_t k = 0; k < places.size(); ++k)
      for (const Vector6& other : places)
        quarters[k].push_back(0.25 * (places[k] - other).squaredNorm());
  }

  struct Nearest {
    std::size_t mean;
    double others;  ///< no other mean is nearer than this
  };

  /// Returns the nearest mean, the first of equal ones. Those farther from the one of `before` than
  /// twice the feature is are no nearer.
  Nearest nearest(const Vector6& feature, std::size_t before) const {
    const double own = (places[before] - feature).squaredNorm(), limit = kRounding * own;
    constexpr double kNone = std::numeric_limits<double>::infinity();
    Nearest best{before, kNone};
    double least = kNone, second = kNone, left_out = kNone;
    for (std::size_t k = 0; k < places.size(); ++k) {
      if (quarters[before][k] > limit) {
        left_out = std::min(left_out, quarters[before][k]);
        continue;
      }
      const double distance = (places[k] - feature).squaredNorm();
      second = std::min(second, std::max(distance, least));
      if (distance < least) {
        least = distance;
        best.mean = k;
      }
    }
    best.others = std::min(std::sqrt(second), 2 * std::sqrt(left_out) - std::sqrt(own));
    return best;
  }

  static constexpr double kRounding = 1 + 1e-9;
  Features places;
  std::vector<std::vector<double>> quarters;
};

/// Returns by how much the mean that moved farthest did.
double moveToMeans(const FaceTable& faces, const Features& features,
                   const std::vector<std::size_t>& owner, Features& means) {
  double farthest = 0;
  Features sums(means.size(), Vector6::Zero());
  std::vector<double> weights(means.size(), 0);
  for (std::size_t i = 0; i < features.size(); ++i) {
    const double weight = std::sqrt(faces.area[i]);
    sums[owner[i]] += weight * features[i];
    weights[owner[i]] += weight;
  }
  for (std::size_t k = 0; k < means.size(); ++k) {
    if (!(weights[k] > 0)) continue;
    const Vector6 mean = sums[k] / weights[k];
    farthest = std::max(farthest, (mean - means[k]).squaredNorm());
    means[k] = mean;
  }
  return std::sqrt(farthest);
}

}  // namespace

FaceClusters clusterFaces(const FaceTable& faces, int count) {
  constexpr int kRounds = 30;
  AMBIENT_ASSERT(count > 0 && static_cast<std::size_t>(count) <= faces.size());
  const Features features = featuresOf(faces);
  Features means = farthestFirst(faces, features, count);
  std::vector<std::size_t> owner(features.size(), 0);
  std::vector<double> others(features.size(), 0);  // no other mean is nearer
  double moved = 0;
  for (int round = 0; round < kRounds; ++round) {
    const Means near(means);
    bool changed = round == 0;
    for (std::size_t i = 0; i < features.size(); ++i) {
      others[i] -= Means::kRounding * moved;
      const double own = (means[owner[i]] - features[i]).norm();
      if (Means::kRounding * own < others[i]) continue;
      const Means::Nearest now = near.nearest(features[i], owner[i]);
      changed |= now.mean != owner[i];
      owner[i] = now.mean;
      others[i] = now.others / Means::kRounding;
    }
    if (!changed) break;
    moved = moveToMeans(faces, features, owner, means);
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
