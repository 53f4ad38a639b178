#include "bullet_ambient/fluid_body/packed_hull.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "bullet_ambient/fluid_body/block_order.h"
#include "bullet_ambient/spatial/spatial_vectors.h"

namespace ambient {
namespace {

using Triangle = std::array<Vector3, 3>;

constexpr double kRoundedUp = 1 + 1e-12;  // of radii

std::vector<Vector3> verticesOf(const Surface& surface) {
  std::vector<Vector3> vertices;
  for (std::size_t i = 0; i + 2 < surface.vertices.size(); i += 3)
    vertices.emplace_back(surface.vertices[i], surface.vertices[i + 1], surface.vertices[i + 2]);
  return vertices;
}

std::vector<Triangle> trianglesOf(const Surface& surface) {
  const std::vector<Vector3> vertices = verticesOf(surface);
  const auto corner = [&](std::size_t i) {
    return vertices[static_cast<std::size_t>(surface.triangles[i])];
  };
  std::vector<Triangle> triangles;
  for (std::size_t t = 0; t + 2 < surface.triangles.size(); t += 3)
    triangles.push_back({corner(t), corner(t + 1), corner(t + 2)});
  return triangles;
}

std::vector<std::uint32_t> orderOf(const std::vector<Vector3>& places, std::size_t block_size) {
  std::vector<Vector6> coordinates;
  coordinates.reserve(places.size());
  for (const Vector3& place : places) coordinates.push_back(stack({0, 0, 0}, place));
  return orderInBlocks(coordinates, block_size);
}

std::vector<Triangle> inBlocks(const std::vector<Triangle>& triangles) {
  std::vector<Vector3> places;
  places.reserve(triangles.size());
  for (const Triangle& t : triangles) places.emplace_back(t[0] + t[1] + t[2]);
  std::vector<Triangle> sorted;
  sorted.reserve(triangles.size());
  for (const std::uint32_t i : orderOf(places, HullBlock::kTriangles))
    sorted.push_back(triangles[i]);
  return sorted;
}

struct Sphere {
  Vector3 centre{0, 0, 0};
  double radius = 0;
};

/// About the middle of their bounding box.
Sphere sphereAround(const Vector3* points, std::size_t count) {
  Vector3 low = points[0], high = points[0];
  for (std::size_t i = 1; i < count; ++i) {
    low = low.cwiseMin(points[i]);
    high = high.cwiseMax(points[i]);
  }
  Sphere sphere{(low + high) / 2, 0};
  for (std::size_t i = 0; i < count; ++i)
    sphere.radius = std::max(sphere.radius, kRoundedUp * (points[i] - sphere.centre).norm());
  return sphere;
}

Vector3 areaNormal(const Triangle& t) { return (t[1] - t[0]).cross(t[2] - t[0]) / 2; }

using Moments = std::array<double, HullMoments::kNumbers>;

/// N = sum A n, M = sum A n c^T, Q_jkl = sum int n_j z_k z_l dA; docs/theory.md eq. (57).
void add(const Triangle& t, Moments& moments) {
  const Vector3 normal = areaNormal(t);
  const Vector3 c = (t[0] + t[1] + t[2]) / 3;
  const Matrix3 second = (t[0] * t[0].transpose() + t[1] * t[1].transpose() +
                          t[2] * t[2].transpose() + 9 * c * c.transpose()) /
                         12;
  double* to = moments.data();
  for (int j = 0; j < 3; ++j) *to++ += normal[j];
  for (int j = 0; j < 3; ++j)
    for (int k = 0; k < 3; ++k) *to++ += normal[j] * c[k];
  for (int j = 0; j < 3; ++j)
    for (int k = 0; k < 3; ++k)
      for (int l = k; l < 3; ++l) *to++ += normal[j] * second(k, l);
}

HullBlock blockOf(const Triangle* triangles, std::size_t count) {
  HullBlock block = {};
  for (std::size_t i = 0; i < count; ++i) {
    const Vector3 normal = areaNormal(triangles[i]);
    for (int axis = 0; axis < 3; ++axis) {
      for (int corner = 0; corner < 3; ++corner)
        block.corner[corner][axis][i] = triangles[i][static_cast<std::size_t>(corner)][axis];
      block.area_normal[axis][i] = normal[axis];
    }
  }
  return block;
}

double volumeOf(const std::vector<Triangle>& triangles) {
  double volume = 0;
  for (const Triangle& t : triangles) volume += t[0].dot(t[1].cross(t[2])) / 6;
  return volume;
}

}  // namespace

PackedHull::PackedHull(const FluidBody& body) {
  packPoints(verticesOf(body.surface));
  if (body.volume > 0) packTriangles(body);
}

void PackedHull::packTriangles(const FluidBody& body) {
  const std::vector<Triangle> triangles = inBlocks(trianglesOf(body.surface));
  const double volume = volumeOf(triangles);
  if (volume > 0) volume_factor_ = body.volume / volume;
  constexpr std::size_t kTriangles = HullBlock::kTriangles, kBlocks = HullMoments::kBlocks;
  for (std::size_t begin = 0; begin < triangles.size(); begin += kTriangles) {
    const std::size_t count = std::min(kTriangles, triangles.size() - begin);
    const std::size_t lane = blocks_.size() % kBlocks;
    if (lane == 0) {
      moments_.push_back({});
      for (double& radius : moments_.back().radius) radius = HullMoments::kNoBlock;
    }
    blocks_.push_back(blockOf(&triangles[begin], count));
    HullMoments& group = moments_.back();
    const Sphere sphere = sphereAround(triangles[begin].data(), 3 * count);
    for (int axis = 0; axis < 3; ++axis) group.centre[axis][lane] = sphere.centre[axis];
    group.radius[lane] = sphere.radius;
    Moments moments = {};
    for (std::size_t i = begin; i < begin + count; ++i) add(triangles[i], moments);
    for (std::size_t number = 0; number < moments.size(); ++number)
      group.moments[number][lane] = moments[number];
  }
}

void PackedHull::packPoints(const std::vector<Vector3>& points) {
  constexpr std::size_t kPoints = 16;
  points_.reserve(points.size());
  for (const std::uint32_t i : orderOf(points, kPoints)) points_.push_back(points[i]);
  for (std::size_t begin = 0; begin < points_.size(); begin += kPoints) {
    const std::size_t end = std::min(begin + kPoints, points_.size());
    const Sphere sphere = sphereAround(&points_[begin], end - begin);
    point_blocks_.push_back({sphere.centre, sphere.radius, begin, end});
  }
}

double PackedHull::farthest(const Vector3& direction) const noexcept {
  double most = -std::numeric_limits<double>::max();
  for (const PointBlock& block : point_blocks_) {
    if (!(direction.dot(block.centre) + block.radius > most)) continue;
    for (std::size_t i = block.begin; i < block.end; ++i)
      most = std::max(most, direction.dot(points_[i]));
  }
  return most;
}

std::pair<double, double> PackedHull::extent(const Vector3& direction) const noexcept {
  if (points_.empty()) return {0, 0};
  return {-farthest(-direction), farthest(direction)};
}

}  // namespace ambient
