#include "preprocess/mesh/wrap/dual_surface.h"

#include <algorithm>
#include <cmath>

#include "bullet_ambient/spatial/symmetric_eigen.h"
#include "preprocess/mesh/defects/surface_crossing.h"
#include "preprocess/mesh/graded_grid.h"
#include "preprocess/mesh/wrap/triangle_pieces.h"

namespace ambient {
namespace {

using Eigen::Vector3d;

/// A point of the surface, and its plane there.
struct SurfacePoint {
  Vector3d point, normal;
};

/// Planes that a vertex should lie on: sums of n n^T, n (n . x) and x.
struct Planes {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  Vector3d right_side = Vector3d::Zero();
  Vector3d sum = Vector3d::Zero();
  int count = 0;

  void add(const SurfacePoint& on) {
    matrix += on.normal * on.normal.transpose();
    right_side += on.normal * on.normal.dot(on.point);
    sum += on.point;
    ++count;
  }

  /// The nearest point to all planes, from their middle in the directions that they determine.
  Vector3d nearestPoint() const {
    constexpr double kDetermined = 0.05;  // of the largest eigenvalue
    const Vector3d middle = sum / count;
    const auto eigen = symmetricEigen<3>(matrix);
    const Vector3d residual = right_side - matrix * middle;
    Vector3d point = middle;
    for (int k = 0; k < 3; ++k) {
      if (eigen.values[k] < kDetermined * eigen.values[2]) continue;
      const Vector3d direction = eigen.vectors.col(k);
      point += direction * (direction.dot(residual) / eigen.values[k]);
    }
    return point;
  }
};

/// Makes the surface, edge of the grid by edge.
class DualContour {
 public:
  DualContour(const TriangleMesh& mesh, const CubicGrid& grid, const GridCrossings& crossings,
              const SolidNodes& nodes)
      : mesh_(mesh), grid_(grid), crossings_(crossings), nodes_(nodes) {}

  TriangleMesh surface() {
    forEachEdge([this](std::int64_t node, int axis) { addPlane(node, axis); });
    for (const auto& [cube, number] : vertex_of_)
      vertices_[static_cast<std::size_t>(number)] =
          vertexIn(cube, planes_[static_cast<std::size_t>(number)]);
    forEachEdge([this](std::int64_t node, int axis) { addTriangles(node, axis); });
    return makeTriangleMesh(vertices_, triangles_);
  }

 private:
  bool isSolid(std::int64_t node) const {
    return nodes_.is_solid[static_cast<std::size_t>(node)] != 0;
  }

  /// Between a solid node and another one.
  template <class Visit>
  void forEachEdge(const Visit& visit) const {
    for (std::int64_t node = 0; node < grid_.nodeCount(); ++node) {
      for (int axis = 0; axis < 3; ++axis) {
        const std::int64_t next = node + grid_.stride(axis);
        if (next < grid_.nodeCount() && isSolid(node) != isSolid(next)) visit(node, axis);
      }
    }
  }

  /// The four cubes at an edge, each by its first node, once around the axis.
  std::array<std::int64_t, 4> cubesAt(std::int64_t node, int axis) const {
    const std::int64_t u = grid_.stride((axis + 1) % 3), v = grid_.stride((axis + 2) % 3);
    return {node - u - v, node - v, node, node - u};
  }

  void addPlane(std::int64_t node, int axis) {
    const SurfacePoint point = pointOn(node, axis);
    for (const std::int64_t cube : cubesAt(node, axis)) {
      const auto [entry, is_new] = vertex_of_.try_emplace(cube, static_cast<int>(planes_.size()));
      if (is_new) {
        planes_.emplace_back();
        vertices_.emplace_back();
      }
      planes_[static_cast<std::size_t>(entry->second)].add(point);
    }
  }

  /// Returns the crossing of the surface with an edge of the grid: of several crossings the one
  /// nearest to the fluid.
  SurfacePoint pointOn(std::int64_t node, int axis) const {
    const bool is_solid = isSolid(node);
    const std::int64_t inner = is_solid ? node : node + grid_.stride(axis);
    const std::int64_t outer = is_solid ? node + grid_.stride(axis) : node;
    const Vector3d from = grid_.pointOf(inner), along = grid_.pointOf(outer) - from;
    if (nodes_.thin.count(inner) > 0) return pointNearThin(inner, outer);
    const LineCrossings* crossings = crossings_.find(node, axis);
    if (crossings == nullptr) return {from + along / 2, along.normalized()};
    const LineCrossing& crossing = is_solid ? crossings->last : crossings->first;
    const TrianglePiece corners = cornersOf(mesh_, crossing.triangle);
    const Vector3d normal =
        (corners.col(1) - corners.col(0)).cross(corners.col(2) - corners.col(0));
    return {from + along * (is_solid ? crossing.along : 1 - crossing.along),
            normal.stableNormalized()};
  }

  /// At kThinReach from the triangles.
  SurfacePoint pointNearThin(std::int64_t inner, std::int64_t outer) const {
    const double reach = kThinReach * grid_.step;
    const ThinPart part = nodes_.thin.at(inner);
    const auto other = nodes_.thin.find(outer);
    const double beyond =
        other == nodes_.thin.end() ? part.distance + grid_.step : other->second.distance;
    // A node that was added to fill a pinch may lie farther off.
    const double share = std::clamp((reach - part.distance) / (beyond - part.distance), 0.0, 1.0);
    const Vector3d from = grid_.pointOf(inner), along = grid_.pointOf(outer) - from;
    const Vector3d point = from + along * (std::isfinite(share) ? share : 0.5);
    const Vector3d outward = point - nearestPoint(cornersOf(mesh_, part.triangle), point);
    return {point, outward.norm() > 0 ? outward.normalized() : along.normalized()};
  }

  /// Inside its cube, so that no two pieces of the surface meet.
  Vector3d vertexIn(std::int64_t cube, const Planes& planes) const {
    constexpr double kInside = 0.02;  // of the step
    const Vector3d low = grid_.pointOf(cube).array() + kInside * grid_.step;
    const Vector3d high = grid_.pointOf(cube).array() + (1 - kInside) * grid_.step;
    return planes.nearestPoint().cwiseMax(low).cwiseMin(high);
  }

  /// Cut along the diagonal that comes closer to the plane of the surface on the edge.
  void addTriangles(std::int64_t node, int axis) {
    std::array<int, 4> corners{};
    const auto cubes = cubesAt(node, axis);
    for (std::size_t i = 0; i < 4; ++i) corners[i] = vertex_of_.at(cubes[i]);
    if (!isSolid(node)) std::swap(corners[1], corners[3]);
    const SurfacePoint on = pointOn(node, axis);
    const auto offPlane = [&](std::size_t i, std::size_t j) {
      const Vector3d middle = (vertexAt(corners[i]) + vertexAt(corners[j])) / 2;
      return std::abs(on.normal.dot(middle - on.point)) +
             1e-3 * (vertexAt(corners[i]) - vertexAt(corners[j])).norm();
    };
    if (offPlane(1, 3) < offPlane(0, 2))
      std::rotate(corners.begin(), corners.begin() + 1, corners.end());
    triangles_.emplace_back(corners[0], corners[1], corners[2]);
    triangles_.emplace_back(corners[0], corners[2], corners[3]);
  }

  const Vector3d& vertexAt(int number) const { return vertices_[static_cast<std::size_t>(number)]; }

  const TriangleMesh& mesh_;
  const CubicGrid& grid_;
  const GridCrossings& crossings_;
  const SolidNodes& nodes_;
  std::unordered_map<std::int64_t, int> vertex_of_;  // per cube, by its first node
  std::vector<Planes> planes_;
  std::vector<Vector3d> vertices_;
  std::vector<Eigen::Vector3i> triangles_;
};

}  // namespace

TriangleMesh makeDualSurface(const TriangleMesh& mesh, const CubicGrid& grid,
                             const GridCrossings& crossings, const SolidNodes& nodes) {
  return DualContour(mesh, grid, crossings, nodes).surface();
}

}  // namespace ambient
