#include "preprocess/mesh/wrap/solid_nodes.h"

#include <cmath>

#include "preprocess/mesh/defects/surface_crossing.h"
#include "preprocess/mesh/wrap/triangle_pieces.h"

namespace ambient {
namespace {

using Eigen::Vector3d;
using Labels = std::vector<char>;

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

/// Keeps, for every node near a thin part, the nearest triangle of it.
class ThinSearch {
 public:
  ThinSearch(const TriangleMesh& mesh, const CubicGrid& grid, const Labels& is_solid)
      : mesh_(mesh), grid_(grid), is_solid_(is_solid), is_near_solid_(dilated(is_solid, grid)) {}

  std::unordered_map<std::int64_t, ThinPart> findAll() {
    for (int t = 0; t < static_cast<int>(mesh_.triangleCount()); ++t) {
      forEachPiece(cornersOf(mesh_, t), kLongestPieceForNodes * grid_.step,
                   [&](const TrianglePiece& piece) { addPiece(piece, t); });
    }
    return std::move(found_);
  }

 private:
  // Notes the distances of nodes near a piece, up to the neighbours of those that become solid.
  void addPiece(const TrianglePiece& piece, int triangle) {
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

  void addNode(std::int64_t node, const TrianglePiece& piece, int triangle) {
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
    return is_near_solid_[static_cast<std::size_t>(nearest)] == 0;
  }

  const TriangleMesh& mesh_;
  const CubicGrid& grid_;
  const Labels& is_solid_;
  Labels is_near_solid_;
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

}  // namespace

SolidNodes findSolidNodes(const TriangleMesh& mesh, const CubicGrid& grid,
                          const GridCrossings& crossings) {
  SolidNodes nodes;
  nodes.is_solid = reachable(
      grid, [&](std::int64_t node, int axis) { return crossings.find(node, axis) == nullptr; });
  for (char& label : nodes.is_solid) label = static_cast<char>(1 - label);
  nodes.thin = ThinSearch(mesh, grid, nodes.is_solid).findAll();
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

}  // namespace ambient
