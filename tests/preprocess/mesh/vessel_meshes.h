#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <utility>
#include <vector>

#include "bullet_ambient/base/pi.h"
#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// Grid lines along each axis, ascending.
using GridLines = std::array<std::vector<double>, 3>;

/// The boundary of the cells of a grid that are solid at their middle: every side of a cell is two
/// triangles.
inline TriangleMesh makeBlocks(GridLines lines,
                               const std::function<bool(const Eigen::Vector3d&)>& is_solid) {
  std::array<int, 3> count{};
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double>& own = lines[axis];
    std::sort(own.begin(), own.end());
    own.erase(std::unique(own.begin(), own.end()), own.end());
    count[axis] = static_cast<int>(own.size()) - 1;
  }
  const auto isFull = [&](const std::array<int, 3>& cell) {
    Eigen::Vector3d middle;
    for (int axis = 0; axis < 3; ++axis) {
      if (cell[axis] < 0 || cell[axis] >= count[axis]) return false;
      middle[axis] = (lines[axis][cell[axis]] + lines[axis][cell[axis] + 1]) / 2;
    }
    return is_solid(middle);
  };
  std::map<std::array<int, 3>, int> numbers;
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Eigen::Vector3i> triangles;
  const auto vertexAt = [&](const std::array<int, 3>& node) {
    const auto [place, is_new] = numbers.emplace(node, static_cast<int>(vertices.size()));
    if (is_new) vertices.emplace_back(lines[0][node[0]], lines[1][node[1]], lines[2][node[2]]);
    return place->second;
  };
  for (int i = 0; i < count[0]; ++i)
    for (int j = 0; j < count[1]; ++j)
      for (int k = 0; k < count[2]; ++k) {
        if (!isFull({i, j, k})) continue;
        for (int axis = 0; axis < 3; ++axis)
          for (const int way : {0, 1}) {
            std::array<int, 3> beyond{i, j, k};
            beyond[axis] += way == 1 ? 1 : -1;
            if (isFull(beyond)) continue;
            const int u = (axis + 1 + (way == 1 ? 0 : 1)) % 3, v = 3 - axis - u;
            std::array<int, 4> corners{};
            for (int c = 0; c < 4; ++c) {
              std::array<int, 3> node{i, j, k};
              node[axis] += way;
              node[u] += c == 1 || c == 2 ? 1 : 0;
              node[v] += c >= 2 ? 1 : 0;
              corners[c] = vertexAt(node);
            }
            triangles.push_back({corners[0], corners[1], corners[2]});
            triangles.push_back({corners[0], corners[2], corners[3]});
          }
      }
  return makeTriangleMesh(vertices, triangles);
}

/// A barge with the keel at z = 0; sizes in metres.
struct Barge {
  double length = 2, width = 1, height = 0.5, wall = 0.02;
  std::vector<double> bulkheads = {};  ///< places along x
  double bulkhead_top = 0.5;
  /// Of a hole through the wall at +x: from and to, y and z; empty: none.
  std::vector<double> hole = {};
  int cells = 1;  ///< along x
};

inline TriangleMesh makeBarge(const Barge& barge) {
  const double x = barge.length / 2, y = barge.width / 2, t = barge.wall;
  GridLines lines{{{-x, -x + t, x - t, x}, {-y, -y + t, y - t, y}, {0, t, barge.height}}};
  for (int i = 1; i < barge.cells; ++i)
    lines[0].push_back(-x + t + (2 * x - 2 * t) * i / barge.cells);
  for (const double place : barge.bulkheads) {
    lines[0].insert(lines[0].end(), {place - t / 2, place + t / 2});
    lines[2].push_back(barge.bulkhead_top);
  }
  if (!barge.hole.empty()) {
    lines[1].insert(lines[1].end(), {barge.hole[0], barge.hole[1]});
    lines[2].insert(lines[2].end(), {barge.hole[2], barge.hole[3]});
  }
  return makeBlocks(lines, [&](const Eigen::Vector3d& p) {
    const bool in_hole = !barge.hole.empty() && p.x() > x - t && p.y() > barge.hole[0] &&
                         p.y() < barge.hole[1] && p.z() > barge.hole[2] && p.z() < barge.hole[3];
    if (in_hole) return false;
    if (std::abs(p.x()) > x - t || std::abs(p.y()) > y - t || p.z() < t) return true;
    return std::any_of(barge.bulkheads.begin(), barge.bulkheads.end(), [&](double place) {
      return std::abs(p.x() - place) < t / 2 && p.z() < barge.bulkhead_top;
    });
  });
}

/// A profile of a body of revolution: radius and height from the axis, or from a point that it ends
/// at too, on; the outside on its right.
using Profile = std::vector<std::pair<double, double>>;

inline TriangleMesh makeLathe(const Profile& profile, int sides) {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Eigen::Vector3i> triangles;
  std::vector<std::vector<int>> rings;
  for (const auto& [radius, height] : profile) {
    const int first = static_cast<int>(vertices.size());
    std::vector<int> ring(static_cast<std::size_t>(sides), first);
    const int count = radius == 0 ? 1 : sides;
    for (int i = 0; i < count; ++i) {
      const double angle = 2 * kPi * i / sides;
      ring[i] = first + i;
      vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), height);
    }
    rings.push_back(ring);
  }
  for (std::size_t r = 0; r + 1 < rings.size(); ++r)
    for (int i = 0; i < sides; ++i) {
      const int j = (i + 1) % sides;
      const int a = rings[r][i], b = rings[r][j], c = rings[r + 1][j], d = rings[r + 1][i];
      if (a != b) triangles.push_back({a, b, c});
      if (c != d) triangles.push_back({a, c, d});
    }
  return makeTriangleMesh(vertices, triangles);
}

/// Half a sphere shell with a flat rim at z = 0.
inline TriangleMesh makeBowl(double radius, double wall, int sides = 64, int rings = 24) {
  Profile profile;
  for (int i = 0; i <= rings; ++i) {
    const double angle = kPi / 2 * i / rings;
    profile.emplace_back(i == 0 ? 0 : radius * std::sin(angle),
                         i == rings ? 0 : -radius * std::cos(angle));
  }
  const double inner = radius - wall;
  for (int i = rings; i >= 0; --i) {
    const double angle = kPi / 2 * i / rings;
    profile.emplace_back(i == 0 ? 0 : inner * std::sin(angle),
                         i == rings ? 0 : -inner * std::cos(angle));
  }
  return makeLathe(profile, sides);
}

/// A beaker, its floor inside at z = wall, its rim at z = height + wall.
inline TriangleMesh makeCup(double radius, double height, double wall, int sides = 64) {
  return makeLathe({{0, 0},
                    {radius + wall, 0},
                    {radius + wall, height + wall},
                    {radius, height + wall},
                    {radius, wall},
                    {0, wall}},
                   sides);
}

}  // namespace ambient
