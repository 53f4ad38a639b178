#include "preprocess/mesh/wrap/grid_crossings.h"

#include <algorithm>
#include <cmath>

#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {
namespace {

using Eigen::Vector3d;

constexpr double kReach = 0.5;          // of the step, beyond an edge without a partner
constexpr double kLongestPiece = 4;     // steps
constexpr double kLineRounding = 1e-7;  // steps; no line slips between two triangles
constexpr double kLeastSlope = 1e-7;    // of a triangle that a line meets

/// Calls `meet` with every line of the grid along `axis` that passes a box: the node that it passes
/// last before the plane through `on_plane` with that normal, and where it meets it. All in steps.
template <class Meet>
void forEachLine(const CubicGrid& grid, int axis, const Eigen::AlignedBox3d& box,
                 const Vector3d& on_plane, const Vector3d& normal, const Meet& meet) {
  if (std::abs(normal[axis]) < kLeastSlope) return;
  const int j = (axis + 1) % 3, k = (axis + 2) % 3;
  const auto first = [&](int i) { return static_cast<std::int64_t>(std::ceil(box.min()[i])); };
  const auto last = [&](int i) { return static_cast<std::int64_t>(std::floor(box.max()[i])); };
  for (std::int64_t u = first(j); u <= last(j); ++u) {
    for (std::int64_t v = first(k); v <= last(k); ++v) {
      Vector3d x;
      x[j] = static_cast<double>(u);
      x[k] = static_cast<double>(v);
      x[axis] =
          on_plane[axis] -
          (normal[j] * (x[j] - on_plane[j]) + normal[k] * (x[k] - on_plane[k])) / normal[axis];
      // A steep plane is met within the box, or not here.
      if (!(x[axis] >= box.min()[axis] && x[axis] <= box.max()[axis])) continue;
      std::array<std::int64_t, 3> place{};
      place[static_cast<std::size_t>(axis)] = static_cast<std::int64_t>(std::floor(x[axis]));
      place[static_cast<std::size_t>(j)] = u;
      place[static_cast<std::size_t>(k)] = v;
      meet(grid.nodeAt(place), x);
    }
  }
}

Eigen::AlignedBox3d boxAround(const TriangleCorners& points, double reach) {
  const Vector3d wider = Vector3d::Constant(reach);
  return {points.rowwise().minCoeff() - wider, points.rowwise().maxCoeff() + wider};
}

/// Whether a point of the plane of a triangle is in it, rounding included.
bool isIn(const TriangleCorners& triangle, const Vector3d& normal, const Vector3d& x) {
  for (int k = 0; k < 3; ++k) {
    const Vector3d a = triangle.col(k), along = triangle.col((k + 1) % 3) - a;
    if (along.cross(x - a).dot(normal) < -kLineRounding * along.norm()) return false;
  }
  return true;
}

TriangleCorners inStepsOf(const CubicGrid& grid, const TriangleMesh& mesh, int t) {
  TriangleCorners corners = cornersOf(mesh, t);
  for (int k = 0; k < 3; ++k) corners.col(k) = grid.inSteps(corners.col(k));
  return corners;
}

double fractionOf(double x) { return x - std::floor(x); }

}  // namespace

GridCrossings::GridCrossings(const TriangleMesh& mesh, const CubicGrid& grid) : grid_(grid) {
  for (int t = 0; t < static_cast<int>(mesh.triangleCount()); ++t) addTriangle(mesh, t);
  const MeshEdges edges = computeMeshEdges(mesh);
  for (const EdgeGroup& edge : edges.edges) {
    if (edge.size() != 1) continue;
    const HalfEdge& side = edges.half_edges[edge.first];
    addOpenEdge(mesh, side.triangle, side.side);
  }
}

void GridCrossings::addTriangle(const TriangleMesh& mesh, int triangle) {
  const TriangleCorners corners = inStepsOf(grid_, mesh, triangle);
  const Vector3d normal = normalOf(corners);
  forEachPiece(corners, kLongestPiece, [&](const TriangleCorners& piece) {
    for (int axis = 0; axis < 3; ++axis) {
      forEachLine(grid_, axis, boxAround(piece, kLineRounding), piece.col(0), normal,
                  [&](std::int64_t node, const Vector3d& x) {
                    if (!isIn(piece, normal, x)) return;
                    add(3 * node + axis, {fractionOf(x[axis]), triangle}, false);
                  });
    }
  });
}

void GridCrossings::addOpenEdge(const TriangleMesh& mesh, int triangle, int side) {
  const TriangleCorners corners = inStepsOf(grid_, mesh, triangle);
  const Vector3d normal = normalOf(corners);
  const Vector3d a = corners.col(side), along = corners.col((side + 1) % 3) - a;
  const int count = std::max(1, static_cast<int>(std::ceil(along.norm() / kLongestPiece)));
  for (int i = 0; i < count; ++i) {
    const Vector3d from = a + along * i / count, to = a + along * (i + 1) / count;
    TriangleCorners ends;
    ends << from, to, to;
    for (int axis = 0; axis < 3; ++axis) {
      forEachLine(grid_, axis, boxAround(ends, kReach), from, normal,
                  [&](std::int64_t node, const Vector3d& x) {
                    if ((nearestOnSegment(x, from, to) - x).norm() > kReach) return;
                    add(3 * node + axis, {fractionOf(x[axis]), triangle}, true);
                  });
    }
  }
}

void GridCrossings::add(std::int64_t line, const LineCrossing& crossing, bool is_gap) {
  const auto [entry, is_new] =
      on_line_.try_emplace(line, LineCrossings{crossing, crossing, is_gap});
  if (is_new) return;
  LineCrossings& found = entry->second;
  if (found.is_gap && !is_gap) {
    found = {crossing, crossing, false};
  } else if (found.is_gap == is_gap) {
    if (crossing.along < found.first.along) found.first = crossing;
    if (crossing.along > found.last.along) found.last = crossing;
  }
}

}  // namespace ambient
