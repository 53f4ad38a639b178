#include "tests/preprocess/potential_flow/study/study_meshes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "bullet_ambient/base/pi.h"
#include "preprocess/mesh/graded_grid.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "tests/support/bodies/graded_meshes.h"

namespace ambient::study {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

/// Triangles around a vertex of the icosahedron, counter-clockwise from outside.
std::vector<int> trianglesAround(const TriangleMesh& mesh, Eigen::Index v) {
  const Vector3d axis = mesh.vertices.col(v).normalized();
  const Vector3d first = axis.unitOrthogonal(), second = axis.cross(first);
  std::vector<std::pair<double, int>> by_angle;
  for (int t = 0; t < mesh.triangleCount(); ++t) {
    if ((mesh.triangles.col(t).array() != static_cast<int>(v)).all()) continue;
    const Vector3d centre = mesh.corner(t, 0) + mesh.corner(t, 1) + mesh.corner(t, 2);
    by_angle.emplace_back(std::atan2(centre.dot(second), centre.dot(first)), t);
  }
  std::sort(by_angle.begin(), by_angle.end());
  std::vector<int> triangles;
  for (const auto& [angle, t] : by_angle) triangles.push_back(t);
  return triangles;
}

/// Corners of the dodecahedron: barycentres of the icosahedron's triangles.
std::vector<Vector3d> dodecahedronCorners(const TriangleMesh& icosahedron) {
  std::vector<Vector3d> corners;
  for (Eigen::Index t = 0; t < icosahedron.triangleCount(); ++t) {
    const Vector3d sum =
        icosahedron.corner(t, 0) + icosahedron.corner(t, 1) + icosahedron.corner(t, 2);
    corners.push_back(sum.normalized());
  }
  return corners;
}

/// Weights of a coarse triangle's three corners, by vertex; a name for shared vertices.
using WeightName = std::array<std::pair<int, int>, 3>;

WeightName nameOf(const Vector3i& corners, const Vector3i& weights) {
  WeightName name;
  for (int k = 0; k < 3; ++k) name[k] = {weights[k] > 0 ? corners[k] : -1, weights[k]};
  std::sort(name.begin(), name.end());
  return name;
}

/// Vertex of a bowl: (ring, step around, surface); rows of the rim lie between the surfaces.
struct BowlVertex {
  int ring, step, surface;
  bool operator<(const BowlVertex& other) const {
    return std::array{ring, step, surface} < std::array{other.ring, other.step, other.surface};
  }
};

}  // namespace

TriangleMesh makeOctahedron() {
  std::vector<Vector3d> vertices;
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {1.0, -1.0}) vertices.emplace_back(sign * Vector3d::Unit(axis));
  std::vector<Vector3i> triangles;
  for (int octant = 0; octant < 8; ++octant) {
    const int x = octant & 1, y = (octant >> 1) & 1, z = (octant >> 2) & 1;
    const bool mirrored = (x + y + z) % 2 == 1;
    triangles.emplace_back(x, mirrored ? 4 + z : 2 + y, mirrored ? 2 + y : 4 + z);
  }
  return makeTriangleMesh(vertices, triangles);
}

TriangleMesh makeIcosahedron() { return makeEllipsoidMesh({1, 1, 1}, 20); }

TriangleMesh makeDodecahedron() {
  const TriangleMesh dual = makeIcosahedron();
  std::vector<Vector3i> triangles;
  for (Eigen::Index v = 0; v < dual.vertexCount(); ++v) {
    const std::vector<int> pentagon = trianglesAround(dual, v);
    for (std::size_t k = 1; k + 1 < pentagon.size(); ++k)
      triangles.emplace_back(pentagon[0], pentagon[k], pentagon[k + 1]);
  }
  return makeTriangleMesh(dodecahedronCorners(dual), triangles);
}

TriangleMesh makeCentredDodecahedron() {
  const TriangleMesh dual = makeIcosahedron();
  std::vector<Vector3d> vertices = dodecahedronCorners(dual);
  std::vector<Vector3i> triangles;
  for (Eigen::Index v = 0; v < dual.vertexCount(); ++v) {
    const std::vector<int> pentagon = trianglesAround(dual, v);
    Vector3d centre = Vector3d::Zero();
    for (const int corner : pentagon) centre += vertices[corner] / 5;
    for (std::size_t k = 0; k < pentagon.size(); ++k)
      triangles.emplace_back(static_cast<int>(vertices.size()), pentagon[k],
                             pentagon[(k + 1) % pentagon.size()]);
    vertices.push_back(centre);
  }
  return makeTriangleMesh(vertices, triangles);
}

TriangleMesh gradedTowardsEdges(const TriangleMesh& coarse, int n) {
  std::map<WeightName, int> numbers;
  std::vector<Vector3d> vertices;
  std::vector<Vector3i> triangles;
  for (Eigen::Index t = 0; t < coarse.triangleCount(); ++t) {
    const auto vertex = [&](int i, int j) {
      const Vector3i weights(n - i - j, i, j);
      const auto [entry, fresh] = numbers.emplace(nameOf(coarse.triangles.col(t), weights),
                                                  static_cast<int>(vertices.size()));
      if (fresh) {
        Vector3d graded;
        for (int k = 0; k < 3; ++k) graded[k] = (1 - std::cos(kPi * weights[k] / n)) / 2;
        graded /= graded.sum();
        vertices.emplace_back(graded[0] * coarse.corner(t, 0) + graded[1] * coarse.corner(t, 1) +
                              graded[2] * coarse.corner(t, 2));
      }
      return entry->second;
    };
    for (int i = 0; i < n; ++i)
      for (int j = 0; i + j < n; ++j) {
        triangles.emplace_back(vertex(i, j), vertex(i + 1, j), vertex(i, j + 1));
        if (i + j < n - 1)
          triangles.emplace_back(vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1));
      }
  }
  return makeTriangleMesh(vertices, triangles);
}

TriangleMesh makeBowl(const BowlMesh& bowl) {
  const int n = bowl.rings;
  std::map<BowlVertex, int> numbers;
  std::vector<Vector3d> vertices;
  std::vector<Vector3i> triangles;
  // Rings at the rim: surfaces 0 (outer) to rim_rows (inner). Only the outer and inner ones
  // continue as domes.
  const auto radiusOf = [&](int surface) {
    const double t = static_cast<double>(surface) / bowl.rim_rows;
    return 1 - bowl.thickness * (bowl.graded ? (1 - std::cos(kPi * t)) / 2 : t);
  };
  const auto vertex = [&](int ring, int step, int surface) {
    step = ring == 0 ? 0 : step % (6 * ring);
    const auto [entry, fresh] =
        numbers.emplace(BowlVertex{ring, step, surface}, static_cast<int>(vertices.size()));
    if (fresh) {
      const double fraction = static_cast<double>(ring) / n;
      const double polar = kPi / 2 * (bowl.graded ? std::sin(kPi / 2 * fraction) : fraction);
      const double azimuth = ring == 0 ? 0 : kPi / 3 * step / ring;
      const double across = std::sin(polar), down = ring == n ? 0 : std::cos(polar);
      vertices.emplace_back(radiusOf(surface) * Vector3d(across * std::cos(azimuth),
                                                         across * std::sin(azimuth), -down));
    }
    return entry->second;
  };
  // Counter-clockwise seen from above, which is from inside the bowl.
  const auto add = [&](int a, int b, int c, bool from_above) {
    triangles.emplace_back(a, from_above ? b : c, from_above ? c : b);
  };
  for (const int surface : {0, bowl.rim_rows})
    for (int sector = 0; sector < 6; ++sector)
      for (int ring = 0; ring < n; ++ring)
        for (int k = 0; k <= ring; ++k) {
          const int inner = vertex(ring, sector * ring + k, surface);
          const int outer = vertex(ring + 1, sector * (ring + 1) + k, surface);
          const int next = vertex(ring + 1, sector * (ring + 1) + k + 1, surface);
          add(inner, outer, next, surface != 0);
          if (k < ring)
            add(inner, next, vertex(ring, sector * ring + k + 1, surface), surface != 0);
        }
  for (int row = 0; row < bowl.rim_rows; ++row)
    for (int k = 0; k < 6 * n; ++k) {
      const int a = vertex(n, k, row), b = vertex(n, k + 1, row);
      const int c = vertex(n, k + 1, row + 1), d = vertex(n, k, row + 1);
      const bool along_ac = k % n < (n + 1) / 2;
      add(a, b, along_ac ? c : d, true);
      add(along_ac ? a : b, c, d, true);
    }
  return makeTriangleMesh(vertices, triangles);
}

double bowlVolume(double thickness) { return 2 * kPi / 3 * (1 - std::pow(1 - thickness, 3)); }

TriangleMesh scaledToVolume(TriangleMesh mesh, double volume) {
  mesh.vertices *= std::cbrt(volume / test::volumeOf(mesh));
  return mesh;
}

}  // namespace ambient::study
