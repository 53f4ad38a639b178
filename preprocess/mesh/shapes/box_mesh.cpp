#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "preprocess/mesh/graded_grid.h"
#include "preprocess/mesh/shapes/primitive_limits.h"
#include "preprocess/mesh/shapes/primitives.h"

namespace ambient {
namespace {

// Even numbers of divisions, proportional to the root of the length (the cell at the end of a
// cosine-graded edge has length L (pi / 2n)^2), the longest edge with `longest` divisions.
int divisions(double length, double longest_length, int longest) {
  const double wanted = longest * std::sqrt(length / longest_length);
  return std::max(2, 2 * static_cast<int>(std::lround(wanted / 2)));
}

std::array<int, 3> boxDivisions(const Eigen::Vector3d& half_sizes, int faces) {
  std::array<int, 3> best{1, 1, 1};
  for (int longest = 2;; longest += 2) {
    std::array<int, 3> n{};
    for (int k = 0; k < 3; ++k) n[k] = divisions(half_sizes[k], half_sizes.maxCoeff(), longest);
    const long long needed = 4LL * (1LL * n[0] * n[1] + 1LL * n[1] * n[2] + 1LL * n[2] * n[0]);
    if (needed > faces) return best;
    best = n;
  }
}

/// Vertices of the box surface, each lattice point once.
class BoxLattice {
 public:
  BoxLattice(const Eigen::Vector3d& half_sizes, const std::array<int, 3>& n) {
    for (int k = 0; k < 3; ++k) coordinates_[k] = cosineSpacing(half_sizes[k], n[k]);
  }

  int point(const std::array<int, 3>& index) {
    const auto [entry, is_new] = indices_.emplace(index, static_cast<int>(points_.size()));
    if (is_new) {
      points_.push_back(
          {coordinates_[0][index[0]], coordinates_[1][index[1]], coordinates_[2][index[2]]});
    }
    return entry->second;
  }

  const std::vector<Eigen::Vector3d>& points() const { return points_; }

 private:
  std::array<std::vector<double>, 3> coordinates_;
  std::map<std::array<int, 3>, int> indices_;
  std::vector<Eigen::Vector3d> points_;
};

}  // namespace

TriangleMesh makeBoxMesh(const Eigen::Vector3d& half_sizes, int faces) {
  for (int k = 0; k < 3; ++k) requirePositiveSize("box", "half size", half_sizes[k]);
  requireFaces("box", faces, 12);
  return makeBoxMesh(half_sizes, boxDivisions(half_sizes, faces));
}

TriangleMesh makeBoxMesh(const Eigen::Vector3d& half_sizes, const std::array<int, 3>& n) {
  BoxLattice lattice(half_sizes, n);
  std::vector<Eigen::Vector3i> triangles;
  for (int axis = 0; axis < 3; ++axis) {
    for (const bool upper : {false, true}) {
      // Seen from outside, columns run along u and rows along v, u x v being the outward normal.
      const int u = (axis + (upper ? 1 : 2)) % 3, v = (axis + (upper ? 2 : 1)) % 3;
      appendGridTriangles(
          n[v], n[u],
          [&](int row, int column) {
            std::array<int, 3> index{};
            index[axis] = upper ? n[axis] : 0;
            index[u] = column;
            index[v] = row;
            return lattice.point(index);
          },
          triangles);
    }
  }
  return makeTriangleMesh(lattice.points(), triangles);
}

TriangleMesh makeRectangularSheetMesh(double size_x, double size_y, int faces) {
  requirePositiveSize("rectangular sheet", "size x", size_x);
  requirePositiveSize("rectangular sheet", "size y", size_y);
  requireFaces("rectangular sheet", faces, 8);
  const double longest_size = std::max(size_x, size_y);
  int nx = 2, ny = 2;
  for (int longest = 4;; longest += 2) {
    const int next_x = divisions(size_x, longest_size, longest);
    const int next_y = divisions(size_y, longest_size, longest);
    if (2LL * next_x * next_y > faces) break;
    nx = next_x;
    ny = next_y;
  }
  std::vector<Eigen::Vector3d> vertices;
  for (const double y : cosineSpacing(size_y / 2, ny)) {
    for (const double x : cosineSpacing(size_x / 2, nx)) vertices.push_back({x, y, 0});
  }
  std::vector<Eigen::Vector3i> triangles;
  appendGridTriangles(
      ny, nx, [nx](int row, int column) { return row * (nx + 1) + column; }, triangles);
  return makeTriangleMesh(vertices, triangles);
}

}  // namespace ambient
