#include "tests/support/bodies/graded_meshes.h"

#include <Eigen/Geometry>
#include <array>
#include <functional>
#include <map>
#include <utility>
#include <vector>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"

namespace ambient::test {
namespace {

using Eigen::Vector3d;

/// Builds triangles from named corners; equal names become one vertex.
template <typename Name>
class NamedMesh {
 public:
  explicit NamedMesh(std::function<Vector3d(const Name&)> position)
      : position_(std::move(position)) {}

  void add(const Name& a, const Name& b, const Name& c) {
    triangles_.emplace_back(vertex(a), vertex(b), vertex(c));
  }

  TriangleMesh mesh() const {
    TriangleMesh mesh;
    mesh.vertices.resize(3, static_cast<Eigen::Index>(vertices_.size()));
    mesh.triangles.resize(3, static_cast<Eigen::Index>(triangles_.size()));
    for (std::size_t i = 0; i < vertices_.size(); ++i) mesh.vertices.col(i) = vertices_[i];
    for (std::size_t i = 0; i < triangles_.size(); ++i) mesh.triangles.col(i) = triangles_[i];
    return mesh;
  }

 private:
  int vertex(const Name& name) {
    const auto [entry, fresh] = number_.emplace(name, static_cast<int>(vertices_.size()));
    if (fresh) vertices_.push_back(position_(name));
    return entry->second;
  }

  std::function<Vector3d(const Name&)> position_;
  std::map<Name, int> number_;
  std::vector<Vector3d> vertices_;
  std::vector<Eigen::Vector3i> triangles_;
};

/// Lists the lattice triangles of a triangle divided n by n: add(i, j) for three corners each.
template <typename Add>
void forLattice(int n, const Add& add) {
  using Node = std::array<int, 2>;
  for (int i = 0; i < n; ++i)
    for (int j = 0; i + j < n; ++j) {
      add(Node{i, j}, Node{i + 1, j}, Node{i, j + 1});
      if (i + j < n - 1) add(Node{i + 1, j}, Node{i + 1, j + 1}, Node{i, j + 1});
    }
}

/// Maps 0 to 1 onto 0 to 1, with quadratic approach to both ends.
double graded(double t) { return (1 - portable::cos(kPi * t)) / 2; }

}  // namespace

TriangleMesh gradedTetrahedron(int n) {
  using Weights = std::array<int, 4>;  // weights of the four corners, sum n
  const std::array<Vector3d, 4> corners = {Vector3d(1, 1, 1), Vector3d(1, -1, -1),
                                           Vector3d(-1, 1, -1), Vector3d(-1, -1, 1)};
  NamedMesh<Weights> mesh([&](const Weights& weights) {
    Vector3d sum = Vector3d::Zero();
    double total = 0;
    for (int k = 0; k < 4; ++k) {
      const double weight = graded(weights[k] / static_cast<double>(n));
      sum += weight * corners[k];
      total += weight;
    }
    return Vector3d(sum / total);
  });
  const int faces[4][3] = {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}};
  for (const auto& face : faces) {
    const auto name = [&](const std::array<int, 2>& node) {
      Weights weights{};
      weights[face[0]] = n - node[0] - node[1];
      weights[face[1]] = node[0];
      weights[face[2]] = node[1];
      return weights;
    };
    forLattice(n, [&](const auto& a, const auto& b, const auto& c) {
      mesh.add(name(a), name(b), name(c));
    });
  }
  return mesh.mesh();
}

TriangleMesh gradedHemisphere(int n) {
  struct Ring {
    int ring, step, cap;  ///< step: one of 6 ring; cap 0: dome, 1: flat face
    bool operator<(const Ring& other) const {
      return std::array{ring, step, cap} < std::array{other.ring, other.step, other.cap};
    }
  };
  NamedMesh<Ring> mesh([&](const Ring& r) {
    const double fraction = static_cast<double>(r.ring) / n;
    const double azimuth = r.ring == 0 ? 0 : kPi / 3 * r.step / r.ring;
    const double polar = kPi / 2 * fraction;
    const double radius = portable::sin(polar);  // both caps: graded towards the rim
    const double z = r.cap == 0 && r.ring < n ? portable::cos(polar) : 0;
    return Vector3d(radius * portable::cos(azimuth), radius * portable::sin(azimuth), z);
  });
  for (int sector = 0; sector < 6; ++sector) {
    const auto name = [&](const std::array<int, 2>& node, int cap) {
      const int ring = node[0] + node[1];
      const int step = ring == 0 ? 0 : (sector * ring + node[1]) % (6 * ring);
      return Ring{ring, step, ring == n ? 0 : cap};
    };
    forLattice(n, [&](const auto& a, const auto& b, const auto& c) {
      mesh.add(name(a, 0), name(b, 0), name(c, 0));
      mesh.add(name(a, 1), name(c, 1), name(b, 1));
    });
  }
  return mesh.mesh();
}

TriangleMesh makeTorus(const TorusShape& shape) {
  using Node = std::array<int, 2>;
  NamedMesh<Node> mesh([&](const Node& node) {
    const double u = 2 * kPi * node[0] / shape.along, v = 2 * kPi * node[1] / shape.around;
    const double r = shape.radius + shape.tube * portable::cos(v);
    return Vector3d(r * portable::cos(u), r * portable::sin(u), shape.tube * portable::sin(v));
  });
  for (int i = 0; i < shape.along; ++i)
    for (int j = 0; j < shape.around; ++j) {
      const int next_i = (i + 1) % shape.along, next_j = (j + 1) % shape.around;
      mesh.add({i, j}, {next_i, j}, {next_i, next_j});
      mesh.add({i, j}, {next_i, next_j}, {i, next_j});
    }
  return mesh.mesh();
}

TriangleMesh twisted(TriangleMesh mesh, double rate) {
  for (Eigen::Index v = 0; v < mesh.vertexCount(); ++v)
    mesh.vertices.col(v) = Eigen::AngleAxisd(rate * mesh.vertices(2, v), Vector3d::UnitZ()) *
                           Vector3d(mesh.vertices.col(v));
  return mesh;
}

double volumeOf(const TriangleMesh& mesh) {
  double sum = 0;
  for (Eigen::Index t = 0; t < mesh.triangleCount(); ++t)
    sum += mesh.corner(t, 0).dot(mesh.corner(t, 1).cross(mesh.corner(t, 2))) / 6;
  return sum;
}

}  // namespace ambient::test
