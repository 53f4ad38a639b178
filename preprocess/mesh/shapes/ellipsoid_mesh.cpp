#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "preprocess/mesh/shapes/primitive_limits.h"
#include "preprocess/mesh/shapes/primitives.h"

namespace ambient {
namespace {

struct Icosahedron {
  std::array<Eigen::Vector3d, 12> corners;
  std::array<std::array<int, 3>, 20> faces;
};

// The orientation with mirror planes x = 0, y = 0 and z = 0: corners (0, +-1, +-phi) and cyclic.
Icosahedron makeIcosahedron() {
  const double phi = (1 + std::sqrt(5.0)) / 2;
  Icosahedron shape;
  int count = 0;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double a : {-1.0, 1.0}) {
      for (const double b : {-phi, phi}) {
        Eigen::Vector3d corner = Eigen::Vector3d::Zero();
        corner[(axis + 1) % 3] = a;
        corner[(axis + 2) % 3] = b;
        shape.corners[count++] = corner;
      }
    }
  }
  int face = 0;
  const auto adjacent = [&shape](int i, int j) {  // edge length 2, the next distance is 2 phi
    return (shape.corners[i] - shape.corners[j]).squaredNorm() < 5;
  };
  for (int i = 0; i < 12; ++i) {
    for (int j = i + 1; j < 12; ++j) {
      for (int k = j + 1; k < 12; ++k) {
        if (!adjacent(i, j) || !adjacent(j, k) || !adjacent(i, k)) continue;
        const Eigen::Vector3d normal =
            (shape.corners[j] - shape.corners[i]).cross(shape.corners[k] - shape.corners[i]);
        const bool outward = normal.dot(shape.corners[i]) > 0;
        shape.faces[face++] = outward ? std::array{i, j, k} : std::array{i, k, j};
      }
    }
  }
  return shape;
}

/// The points i A + j B + k C, i + j + k = n, of all faces, shared along edges and at corners.
class GeodesicLattice {
 public:
  explicit GeodesicLattice(int frequency) : frequency_(frequency) {}

  int point(const std::array<int, 3>& face, int j, int k) {
    // Weights by corner, in the order of the corners: the same key from every face that shares it.
    std::map<int, int> weights;
    const std::array<int, 3> lattice{frequency_ - j - k, j, k};
    for (int c = 0; c < 3; ++c) {
      if (lattice[c] > 0) weights[face[c]] = lattice[c];
    }
    const auto [entry, is_new] = indices_.emplace(weights, static_cast<int>(points_.size()));
    if (is_new) points_.push_back(position(weights));
    return entry->second;
  }

  const std::vector<Eigen::Vector3d>& points() const { return points_; }
  const Icosahedron& icosahedron() const { return icosahedron_; }

 private:
  Eigen::Vector3d position(const std::map<int, int>& weights) const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const auto& [corner, weight] : weights) sum += weight * icosahedron_.corners[corner];
    return sum.normalized();
  }

  int frequency_;
  Icosahedron icosahedron_ = makeIcosahedron();
  std::map<std::map<int, int>, int> indices_;
  std::vector<Eigen::Vector3d> points_;
};

}  // namespace

TriangleMesh makeEllipsoidMesh(const Eigen::Vector3d& semi_axes, int faces) {
  for (int k = 0; k < 3; ++k) requirePositiveSize("ellipsoid", "semi-axis", semi_axes[k]);
  requireFaces("ellipsoid", faces, 20);
  int n = static_cast<int>(std::sqrt(faces / 20.0));
  while (20LL * (n + 1) * (n + 1) <= faces) ++n;

  GeodesicLattice lattice(n);
  TriangleMesh mesh;
  mesh.triangles.resize(3, 20 * n * n);
  Eigen::Index t = 0;
  for (const std::array<int, 3>& face : lattice.icosahedron().faces) {
    const auto at = [&](int j, int k) { return lattice.point(face, j, k); };
    for (int j = 0; j < n; ++j) {
      for (int k = 0; j + k < n; ++k) {
        mesh.triangles.col(t++) << at(j, k), at(j + 1, k), at(j, k + 1);
        if (j + k + 1 < n) mesh.triangles.col(t++) << at(j + 1, k), at(j + 1, k + 1), at(j, k + 1);
      }
    }
  }
  mesh.vertices.resize(3, static_cast<Eigen::Index>(lattice.points().size()));
  for (Eigen::Index v = 0; v < mesh.vertexCount(); ++v) {
    mesh.vertices.col(v) = semi_axes.cwiseProduct(lattice.points()[v]);
  }
  return mesh;
}

}  // namespace ambient
