#include "preprocess/mesh/union/bsp_tree.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace ambient {
namespace {

using Eigen::Vector3d;
using Polygons = std::vector<FlatPolygon>;

/// Polygons that still have to find their place below a node, on one side of it.
struct Pending {
  int parent;
  bool front;
  Polygons polygons;
};

/// Returns the point of height 0 on the segment from a to b; the same bits if both ends are
/// swapped.
Vector3d crossing(const Vector3d& a, double height_a, const Vector3d& b, double height_b) {
  if (height_a < height_b) return crossing(b, height_b, a, height_a);
  return a + (b - a) * (height_a / (height_a - height_b));
}

}  // namespace

Polygons polygonsOf(const TriangleMesh& mesh) {
  Polygons polygons;
  for (Eigen::Index t = 0; t < mesh.triangleCount(); ++t) {
    const Vector3d a = mesh.corner(t, 0), b = mesh.corner(t, 1), c = mesh.corner(t, 2);
    const Vector3d normal = (b - a).cross(c - a);
    if (normal.norm() > 0) polygons.push_back({{a, b, c}, normal.normalized()});
  }
  return polygons;
}

BspTree::BspTree(const TriangleMesh& mesh, double tolerance) : tolerance_(tolerance) {
  std::vector<Pending> pending;
  pending.push_back({-1, false, polygonsOf(mesh)});
  while (!pending.empty()) {
    const Pending next = std::move(pending.back());
    pending.pop_back();
    const FlatPolygon& first = next.polygons.front();
    const int number = static_cast<int>(nodes_.size());
    if (nodes_.size() == kMostPlanes) throw std::runtime_error("too many triangles in one of them");
    nodes_.push_back({first.normal, first.normal.dot(first.corners.front())});
    if (next.parent >= 0) {
      Node& parent = nodes_[static_cast<std::size_t>(next.parent)];
      (next.front ? parent.front : parent.back) = number;
    }
    Polygons front, back;
    for (const FlatPolygon& polygon : next.polygons) {
      Sides sides = divide(nodes_.back(), polygon);
      if (sides.is_flat) continue;
      if (!sides.front.corners.empty()) front.push_back(std::move(sides.front));
      if (!sides.back.corners.empty()) back.push_back(std::move(sides.back));
    }
    is_convex_ = is_convex_ && front.empty();
    if (!front.empty()) pending.push_back({number, true, std::move(front)});
    if (!back.empty()) pending.push_back({number, false, std::move(back)});
  }
}

BspTree::Sides BspTree::divide(const Node& node, const FlatPolygon& polygon) const {
  const std::size_t count = polygon.corners.size();
  std::vector<double> heights(count);
  bool has_front = false, has_back = false;
  for (std::size_t i = 0; i < count; ++i) {
    heights[i] = node.normal.dot(polygon.corners[i]) - node.offset;
    if (std::abs(heights[i]) <= tolerance_) heights[i] = 0;
    has_front = has_front || heights[i] > 0;
    has_back = has_back || heights[i] < 0;
  }
  Sides sides;
  sides.front.normal = sides.back.normal = polygon.normal;
  sides.is_flat = !has_front && !has_back;
  if (!has_back && has_front) sides.front = polygon;
  if (!has_front && has_back) sides.back = polygon;
  if (!has_front || !has_back) return sides;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t next = (i + 1) % count;
    if (heights[i] >= 0) sides.front.corners.push_back(polygon.corners[i]);
    if (heights[i] <= 0) sides.back.corners.push_back(polygon.corners[i]);
    if (heights[i] * heights[next] >= 0) continue;
    const Vector3d point =
        crossing(polygon.corners[i], heights[i], polygon.corners[next], heights[next]);
    sides.front.corners.push_back(point);
    sides.back.corners.push_back(point);
  }
  return sides;
}

void BspTree::divide(int number, const FlatPolygon& polygon, Polygons& outside, Polygons& inside,
                     bool keep_coplanar) const {
  if (number == kOutside) return outside.push_back(polygon);
  if (number == kInside) return inside.push_back(polygon);
  const Node& node = nodes_[static_cast<std::size_t>(number)];
  const Sides sides = divide(node, polygon);
  if (!sides.front.corners.empty()) divide(node.front, sides.front, outside, inside, keep_coplanar);
  if (!sides.back.corners.empty()) divide(node.back, sides.back, outside, inside, keep_coplanar);
  if (!sides.is_flat) return;
  // In the plane: the solid must be neither where the normal points to, nor, if the other one keeps
  // what is coplanar, behind it.
  const bool is_coplanar = node.normal.dot(polygon.normal) > 0;
  Polygons free;
  divide(is_coplanar ? node.front : node.back, polygon, free, inside, keep_coplanar);
  for (const FlatPolygon& piece : free) {
    Polygons without, within;
    divide(is_coplanar ? node.back : node.front, piece, without, within, keep_coplanar);
    outside.insert(outside.end(), without.begin(), without.end());
    Polygons& coplanar = keep_coplanar ? outside : inside;
    coplanar.insert(coplanar.end(), within.begin(), within.end());
  }
}

Polygons BspTree::clip(const FlatPolygon& polygon, bool keep_coplanar) const {
  Polygons outside, inside;
  divide(0, polygon, outside, inside, keep_coplanar);
  if (inside.empty()) return {polygon};
  return is_convex_ && inside.size() == 1 ? piecesAround(inside.front(), polygon) : outside;
}

Polygons BspTree::piecesAround(const FlatPolygon& hole, const FlatPolygon& polygon) const {
  Polygons pieces;
  FlatPolygon left = polygon;
  for (const Node& node : nodes_) {
    const auto is_on = [&](const Vector3d& corner) {
      return std::abs(node.normal.dot(corner) - node.offset) <= tolerance_;
    };
    if (std::count_if(hole.corners.begin(), hole.corners.end(), is_on) < 2) continue;
    Sides sides = divide(node, left);
    if (sides.is_flat || sides.front.corners.empty()) continue;
    pieces.push_back(std::move(sides.front));
    if (sides.back.corners.empty()) break;
    left = std::move(sides.back);
  }
  return pieces;
}

}  // namespace ambient
