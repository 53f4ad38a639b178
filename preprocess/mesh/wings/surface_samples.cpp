#include "preprocess/mesh/wings/surface_samples.h"

#include <algorithm>
#include <cmath>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"

namespace ambient {
namespace {

using Eigen::Vector3d;

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

Vector3d pointIn(const TriangleMesh& mesh, int triangle, SampleNumbers& random) {
  double u = random.next(), v = random.next();
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
  SampleNumbers random(1);
  SurfaceSamples samples;
  samples.spacing = std::sqrt(area / count);
  for (int i = 0; i < count; ++i) {
    SurfaceSample sample;
    const double at = (i + random.next()) / count * area;
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

}  // namespace ambient
