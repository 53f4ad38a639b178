#include "preprocess/mesh/wings/triangle_tree.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "preprocess/base/numerics.h"
#include "preprocess/mesh/geometry.h"

namespace ambient {

using Eigen::Vector3d;

TriangleTree::TriangleTree(const TriangleMesh& mesh)
    : mesh_(mesh),
      least_(1e-7 * mesh.extents().maxCoeff()),
      order_(static_cast<std::size_t>(mesh.triangleCount())) {
  std::iota(order_.begin(), order_.end(), 0);
  Eigen::Matrix3Xd middles(3, mesh.triangleCount());
  for (Eigen::Index t = 0; t < mesh.triangleCount(); ++t) middles.col(t) = mesh.barycentre(t);
  if (!order_.empty()) build(0, static_cast<int>(order_.size()), middles);
}

void TriangleTree::build(int first, int count, const Eigen::Matrix3Xd& middles) {
  constexpr int kLeaf = 4;
  const std::size_t here = nodes_.size();
  nodes_.emplace_back();
  Eigen::AlignedBox3d box, of_middles;
  for (int i = first; i < first + count; ++i) {
    const int t = order_[static_cast<std::size_t>(i)];
    for (int k = 0; k < 3; ++k) box.extend(Vector3d(mesh_.corner(t, k)));
    of_middles.extend(Vector3d(middles.col(t)));
  }
  nodes_[here].box = box;
  if (count <= kLeaf) {
    nodes_[here].first = first;
    nodes_[here].count = count;
    return;
  }
  Eigen::Index axis = 0;
  of_middles.sizes().maxCoeff(&axis);
  const int half = count / 2;
  const auto begin = order_.begin() + first;
  std::nth_element(begin, begin + half, begin + count, [&](int a, int b) {
    return std::make_pair(middles(axis, a), a) < std::make_pair(middles(axis, b), b);
  });
  build(first, half, middles);
  nodes_[here].first = static_cast<int>(nodes_.size());
  build(first + half, count - half, middles);
}

double TriangleTree::crossing(int triangle, const Vector3d& from, const Vector3d& direction) const {
  constexpr double kRim = 1e-9;  // of a triangle: edges belong to both of their sides
  const Vector3d a = mesh_.corner(triangle, 0), e1 = mesh_.corner(triangle, 1) - a,
                 e2 = mesh_.corner(triangle, 2) - a;
  const Vector3d p = direction.cross(e2);
  const double determinant = p.dot(e1);
  if (!(e1.cross(e2).dot(direction) > 0)) return kNever;
  const Vector3d to = from - a;
  const double u = to.dot(p) / determinant;
  const Vector3d q = to.cross(e1);
  const double v = q.dot(direction) / determinant;
  if (!(u >= -kRim && v >= -kRim && u + v <= 1 + kRim)) return kNever;
  const double way = q.dot(e2) / determinant;
  return way > least_ ? way : kNever;
}

double TriangleTree::leave(const Vector3d& from, const Vector3d& direction) const {
  double nearest = kNever;
  const Vector3d inverse = direction.cwiseInverse();
  const auto misses = [&](const Eigen::AlignedBox3d& box) {
    double in = 0, out = nearest;
    for (int axis = 0; axis < 3; ++axis) {
      if (direction[axis] == 0) {
        if (from[axis] < box.min()[axis] - least_ || from[axis] > box.max()[axis] + least_)
          return true;
        continue;
      }
      const double a = (box.min()[axis] - least_ - from[axis]) * inverse[axis];
      const double b = (box.max()[axis] + least_ - from[axis]) * inverse[axis];
      in = std::max(in, std::min(a, b));
      out = std::min(out, std::max(a, b));
    }
    return in > out;
  };
  std::vector<int> pending;
  if (!nodes_.empty()) pending.push_back(0);
  while (!pending.empty()) {
    const Node& node = nodes_[static_cast<std::size_t>(pending.back())];
    const int number = pending.back();
    pending.pop_back();
    if (misses(node.box)) continue;
    for (int i = node.first; i < node.first + node.count; ++i)
      nearest = std::min(nearest, crossing(order_[static_cast<std::size_t>(i)], from, direction));
    if (node.count > 0) continue;
    pending.push_back(node.first);
    pending.push_back(number + 1);
  }
  return nearest;
}

int TriangleTree::nearest(const Vector3d& point) const {
  double least = kNever;
  int found = 0;
  std::vector<int> pending{0};
  while (!pending.empty()) {
    const int number = pending.back();
    const Node& node = nodes_[static_cast<std::size_t>(number)];
    pending.pop_back();
    if (node.box.squaredExteriorDistance(point) > least) continue;
    for (int i = node.first; i < node.first + node.count; ++i) {
      const int t = order_[static_cast<std::size_t>(i)];
      if (!(mesh_.twiceArea(t).norm() > 0)) continue;
      const double square = (nearestPoint(cornersOf(mesh_, t), point) - point).squaredNorm();
      if (square > least || (square == least && t > found)) continue;
      least = square;
      found = t;
    }
    if (node.count > 0) continue;
    pending.push_back(node.first);
    pending.push_back(number + 1);
  }
  return found;
}

namespace {

constexpr double kThickest = 0.35;  // of the size of the body: not looked at beyond
constexpr int kLines = 6;           // through the middle of the solid, across the normal

/// Shortest way through the solid from its middle, across the normal.
double chordAt(const SurfaceSample& sample, const TriangleTree& tree) {
  Eigen::Index least = 0;
  sample.normal.cwiseAbs().minCoeff(&least);
  const Vector3d first = sample.normal.cross(Vector3d::Unit(least)).normalized();
  const Vector3d second = sample.normal.cross(first);
  double chord = TriangleTree::kNever;
  for (int k = 0; k < kLines; ++k) {
    const double angle = k * kPi / kLines;
    const Vector3d along = portable::cos(angle) * first + portable::sin(angle) * second;
    chord = std::min(chord, tree.leave(sample.middle, along) + tree.leave(sample.middle, -along));
  }
  return chord;
}

Vector3d pointIn(const TriangleMesh& mesh, int triangle, SplitMix64& random) {
  double u = random.uniform(), v = random.uniform();
  if (u + v > 1) {
    u = 1 - u;
    v = 1 - v;
  }
  const Vector3d a = mesh.corner(triangle, 0);
  return a + u * (mesh.corner(triangle, 1) - a) + v * (mesh.corner(triangle, 2) - a);
}

}  // namespace

SurfaceSamples sampleSurface(const TriangleMesh& mesh, const TriangleTree& tree, int count) {
  std::vector<double> areas;  // up to each triangle
  double area = 0;
  for (Eigen::Index t = 0; t < mesh.triangleCount(); ++t)
    areas.push_back(area += mesh.twiceArea(t).norm() / 2);
  const double size = mesh.extents().maxCoeff();
  SplitMix64 random(1);
  SurfaceSamples samples;
  samples.spacing = std::sqrt(area / count);
  for (int i = 0; i < count; ++i) {
    SurfaceSample sample;
    const double at = (i + random.uniform()) / count * area;
    const auto found = std::upper_bound(areas.begin(), areas.end() - 1, at);
    sample.triangle = static_cast<int>(found - areas.begin());
    sample.place = pointIn(mesh, sample.triangle, random);
    sample.normal = mesh.twiceArea(sample.triangle).normalized();
    sample.thickness = tree.leave(sample.place, -sample.normal);
    if (!(sample.thickness < 10 * size)) sample.thickness = size;
    sample.middle = sample.place - sample.thickness / 2 * sample.normal;
    if (sample.thickness < kThickest * size)
      sample.is_thin = sample.thickness < kThinPart * chordAt(sample, tree);
    samples.all.push_back(sample);
  }
  return samples;
}

std::optional<Thickness> findThinnestPart(const TriangleMesh& mesh) {
  AMBIENT_ASSERT(isClosed(computeMeshEdges(mesh)));
  constexpr Eigen::Index kMostRays = 2000;
  const Eigen::Index step = std::max<Eigen::Index>(1, mesh.triangleCount() / kMostRays);
  const TriangleTree tree(mesh);
  std::optional<Thickness> thinnest;
  for (Eigen::Index t = 0; t < mesh.triangleCount(); t += step) {
    const double thickness = tree.leave(mesh.barycentre(t), -mesh.twiceArea(t).normalized());
    if (!(thickness < (thinnest ? thinnest->thickness : TriangleTree::kNever))) continue;
    thinnest = Thickness{thickness, static_cast<int>(t), mesh.barycentre(t)};
  }
  return thinnest;
}

}  // namespace ambient
