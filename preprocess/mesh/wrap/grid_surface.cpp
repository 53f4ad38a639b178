#include "preprocess/mesh/wrap/grid_surface.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

#include "bullet_ambient/spatial/rotation.h"
#include "bullet_ambient/spatial/symmetric_eigen.h"
#include "preprocess/mesh/geometry.h"
#include "preprocess/mesh/triangle_mesh.h"
#include "preprocess/mesh/wrap/grid_crossings.h"

namespace ambient {
namespace {

using Eigen::Vector3d;

using Labels = std::vector<char>;

/// Distance of a node from a thin part of the surface.
struct ThinPart {
  double distance = 0;  ///< [m]
  int triangle = 0;     ///< nearest triangle
};

/// Solid nodes of a grid: nodes inside a surface that need not be closed, or near it.
struct SolidNodes {
  std::vector<char> is_solid;  ///< per node
  /// Nodes near thin parts of the surface that the surface itself does not enclose, by number.
  std::unordered_map<std::int64_t, ThinPart> thin;
};

/// Half of the thickness that thin parts get, over the step of the grid [1]; so thick that each
/// grid line through a thin part has a node in it.
constexpr double kThinReach = 0.75;

constexpr double kLongestPieceForNodes = 3;  // steps

/// All nodes that can be reached from node 0; `isOpen(node, axis)` tells whether one can pass from
/// a node to the next one along an axis.
template <class IsOpen>
Labels reachable(const CubicGrid& grid, const IsOpen& isOpen) {
  Labels is_reached(static_cast<std::size_t>(grid.nodeCount()), 0);
  std::vector<std::int64_t> open{0};
  is_reached[0] = 1;
  const auto reach = [&](std::int64_t node) {
    char& reached = is_reached[static_cast<std::size_t>(node)];
    if (reached == 0) open.push_back(node);
    reached = 1;
  };
  while (!open.empty()) {
    const std::int64_t node = open.back();
    open.pop_back();
    const auto place = grid.placeOf(node);
    for (int axis = 0; axis < 3; ++axis) {
      const auto k = static_cast<std::size_t>(axis);
      const std::int64_t stride = grid.stride(axis);
      if (place[k] > 0 && isOpen(node - stride, axis)) reach(node - stride);
      if (place[k] + 1 < grid.counts[k] && isOpen(node, axis)) reach(node + stride);
    }
  }
  return is_reached;
}

/// Nodes from which a step along each axis, at most, leads to a marked one.
Labels dilated(Labels labels, const CubicGrid& grid) {
  for (int axis = 0; axis < 3; ++axis) {
    const Labels before = labels;
    const auto stride = static_cast<std::size_t>(grid.stride(axis));
    for (std::size_t i = stride; i < labels.size(); ++i) {
      labels[i] = static_cast<char>(labels[i] | before[i - stride]);
      labels[i - stride] = static_cast<char>(labels[i - stride] | before[i]);
    }
  }
  return labels;
}

/// Nodes beside plates that pass between two nodes outside of them: both sides of the plate, or the
/// sheet, meet the line from one to the other. A line that grazes a round body meets it twice, too,
/// but not across.
Labels besidePlates(const TriangleMesh& mesh, const CubicGrid& grid, const GridCrossings& crossings,
                    const Labels& is_solid) {
  constexpr double kAlike = 0.9;   // cosine of the normals of both sides
  constexpr double kAcross = 0.5;  // least cosine of a side's normal and the line
  Labels is_beside(is_solid.size(), 0);
  for (std::int64_t node = 0; node < grid.nodeCount(); ++node) {
    if (is_solid[static_cast<std::size_t>(node)] != 0) continue;
    for (int axis = 0; axis < 3; ++axis) {
      const LineCrossings* passed = crossings.find(node, axis);
      if (passed == nullptr || passed->is_gap) continue;
      const auto next = static_cast<std::size_t>(node + grid.stride(axis));
      if (next >= is_solid.size() || is_solid[next] != 0) continue;
      const Vector3d near = normalOf(cornersOf(mesh, passed->first.triangle));
      const Vector3d far = normalOf(cornersOf(mesh, passed->last.triangle));
      if (std::abs(near.dot(far)) < kAlike || std::abs(near[axis]) < kAcross) continue;
      is_beside[static_cast<std::size_t>(node)] = 1;
      is_beside[next] = 1;
    }
  }
  return is_beside;
}

/// Keeps, for every node near a thin part, the nearest triangle of it.
class ThinSearch {
 public:
  ThinSearch(const TriangleMesh& mesh, const CubicGrid& grid, const GridCrossings& crossings,
             const Labels& is_solid)
      : mesh_(mesh),
        grid_(grid),
        is_solid_(is_solid),
        is_near_solid_(dilated(is_solid, grid)),
        is_beside_plate_(besidePlates(mesh, grid, crossings, is_solid)) {}

  std::unordered_map<std::int64_t, ThinPart> findAll() {
    for (int t = 0; t < static_cast<int>(mesh_.triangleCount()); ++t) {
      forEachPiece(cornersOf(mesh_, t), kLongestPieceForNodes * grid_.step,
                   [&](const TriangleCorners& piece) { addPiece(piece, t); });
    }
    return std::move(found_);
  }

 private:
  // Notes the distances of nodes near a piece, up to the neighbours of those that become solid.
  void addPiece(const TriangleCorners& piece, int triangle) {
    const double reach = kThinReach + 1;
    const Vector3d low = grid_.inSteps(piece.rowwise().minCoeff()),
                   high = grid_.inSteps(piece.rowwise().maxCoeff());
    std::array<std::int64_t, 3> first{}, last{}, place{};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Eigen::Index>(k);
      first[k] = static_cast<std::int64_t>(std::ceil(low[axis] - reach));
      last[k] = static_cast<std::int64_t>(std::floor(high[axis] + reach));
    }
    for (place[2] = first[2]; place[2] <= last[2]; ++place[2]) {
      for (place[1] = first[1]; place[1] <= last[1]; ++place[1]) {
        for (place[0] = first[0]; place[0] <= last[0]; ++place[0])
          addNode(grid_.nodeAt(place), piece, triangle);
      }
    }
  }

  void addNode(std::int64_t node, const TriangleCorners& piece, int triangle) {
    if (is_solid_[static_cast<std::size_t>(node)] != 0) return;
    const Vector3d point = grid_.pointOf(node);
    const Vector3d nearest = nearestPoint(piece, point);
    const double distance = (nearest - point).norm();
    if (distance > (kThinReach + 1) * grid_.step || !isThinAt(nearest)) return;
    const auto [entry, is_new] = found_.try_emplace(node, ThinPart{distance, triangle});
    if (!is_new && distance < entry->second.distance) entry->second = {distance, triangle};
  }

  bool isThinAt(const Vector3d& point) const {
    const Vector3d place = grid_.inSteps(point);
    const auto nearest =
        grid_.nodeAt({std::llround(place.x()), std::llround(place.y()), std::llround(place.z())});
    return is_near_solid_[static_cast<std::size_t>(nearest)] == 0 ||
           is_beside_plate_[static_cast<std::size_t>(nearest)] != 0;
  }

  const TriangleMesh& mesh_;
  const CubicGrid& grid_;
  const Labels& is_solid_;
  Labels is_near_solid_, is_beside_plate_;
  std::unordered_map<std::int64_t, ThinPart> found_;
};

/// Fills one node of every square of four, and of every cube of eight, in which two opposite ones
/// differ from all others; returns how many.
std::int64_t fillPinches(const CubicGrid& grid, Labels& is_solid) {
  std::int64_t filled = 0;
  const auto solid = [&](std::int64_t node) -> char& {
    return is_solid[static_cast<std::size_t>(node)];
  };
  const auto fill = [&](std::int64_t node) {
    filled += solid(node) == 0 ? 1 : 0;
    solid(node) = 1;
  };
  const std::int64_t last = grid.nodeCount() - grid.stride(0) - grid.stride(1) - grid.stride(2);
  for (std::int64_t node = 0; node < last; ++node) {
    for (int axis = 0; axis < 3; ++axis) {
      const std::int64_t u = grid.stride(axis), v = grid.stride((axis + 1) % 3);
      const int a = solid(node), b = solid(node + u), c = solid(node + u + v), d = solid(node + v);
      if (a == c && b == d && a != b) fill(a == 0 ? node : node + u);
    }
    std::array<std::int64_t, 8> cube{};
    int count = 0;
    for (std::size_t i = 0; i < 8; ++i) {
      cube[i] = node;
      for (int axis = 0; axis < 3; ++axis) cube[i] += ((i >> axis) & 1u) * grid.stride(axis);
      count += solid(cube[i]);
    }
    if (count != 2 && count != 6) continue;
    for (std::size_t i = 0; i < 4; ++i) {
      if (solid(cube[i]) != solid(cube[7 - i]) || solid(cube[i]) != (count == 2 ? 1 : 0)) continue;
      fill(count == 2 ? cube[i ^ 1u] : cube[i]);
    }
  }
  return filled;
}

/// Finds the solid nodes. A node is solid if it cannot be reached from outside along grid lines
/// without crossing the surface or a gap narrower than a step. It is also solid if it is closer
/// than kThinReach steps to parts of the surface that enclose no node: sheets, plates and rods
/// thinner than the grid resolves, open shells. Nodes are added until solid and fluid touch nowhere
/// in an edge or a corner alone, and no fluid is enclosed, so that every cube of the grid holds one
/// piece of the boundary at most. Cost O(nodes + T + A / step^2).
SolidNodes findSolidNodes(const TriangleMesh& mesh, const CubicGrid& grid,
                          const GridCrossings& crossings) {
  SolidNodes nodes;
  nodes.is_solid = reachable(
      grid, [&](std::int64_t node, int axis) { return crossings.find(node, axis) == nullptr; });
  for (char& label : nodes.is_solid) label = static_cast<char>(1 - label);
  nodes.thin = ThinSearch(mesh, grid, crossings, nodes.is_solid).findAll();
  Labels& is_solid = nodes.is_solid;
  for (const auto& [node, part] : nodes.thin) {
    if (part.distance <= kThinReach * grid.step) is_solid[static_cast<std::size_t>(node)] = 1;
  }
  do {
    const Labels is_fluid = reachable(grid, [&](std::int64_t node, int axis) {
      return is_solid[static_cast<std::size_t>(node)] == 0 &&
             is_solid[static_cast<std::size_t>(node + grid.stride(axis))] == 0;
    });
    for (std::size_t i = 0; i < is_solid.size(); ++i)
      is_solid[i] = static_cast<char>(1 - is_fluid[i]);
  } while (fillPinches(grid, is_solid) > 0);
  return nodes;
}

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
    return {from + along * (is_solid ? crossing.along : 1 - crossing.along),
            normalOf(cornersOf(mesh_, crossing.triangle))};
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

TriangleMesh makeGridSurface(const TriangleMesh& mesh, const CubicGrid& grid) {
  const GridCrossings crossings(mesh, grid);
  return DualContour(mesh, grid, crossings, findSolidNodes(mesh, grid, crossings)).surface();
}

namespace {

/// An end of what a line has in a part.
struct LineEnd {
  double height = 0;  ///< [steps]
  int depth = 0;      ///< 1: the part begins there, -1: it ends
};

/// Returns the length of a line in any part [steps].
double lengthInside(std::vector<LineEnd>& ends) {
  std::sort(ends.begin(), ends.end(),
            [](const LineEnd& a, const LineEnd& b) { return a.height < b.height; });
  double length = 0;
  int depth = 0;
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    depth += ends[i].depth;
    if (depth > 0) length += ends[i + 1].height - ends[i].height;
  }
  return length;
}

}  // namespace

double volumeOfUnion(const std::vector<TriangleMesh>& parts) {
  constexpr int kLines = 300;          // across the longest side
  const Vector3d turn(0.3, 0.7, 0.5);  // of the parts: no side of a box is along the lines
  TriangleMesh all = joinMeshes(parts);
  all.vertices = rotationFromVector(turn).toRotationMatrix() * all.vertices;
  CubicGrid grid;
  grid.origin = all.bounds().min();
  grid.step = all.extents().maxCoeff() / kLines;
  for (int axis = 0; axis < 3; ++axis)
    grid.counts[axis] = static_cast<std::int64_t>(all.extents()[axis] / grid.step) + 2;
  std::vector<std::vector<LineEnd>> ends(static_cast<std::size_t>(grid.stride(2)));
  for (int t = 0; t < static_cast<int>(all.triangleCount()); ++t) {
    const TriangleCorners corners = inStepsOf(grid, all, t);
    const Vector3d normal = normalOf(corners);
    forEachLine(grid, 2, boxAround(corners, 0), corners.col(0), normal,
                [&](std::int64_t node, const Vector3d& x) {
                  if (isIn(corners, normal, x))
                    ends[node % grid.stride(2)].push_back({x.z(), normal.z() < 0 ? 1 : -1});
                });
  }
  double length = 0;
  for (std::vector<LineEnd>& line : ends) length += lengthInside(line);
  return length * grid.step * grid.step * grid.step;
}

}  // namespace ambient
