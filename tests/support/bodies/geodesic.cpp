#include "tests/support/bodies/geodesic.h"

#include <Eigen/Geometry>
#include <cmath>

namespace ambient::test {
namespace {

Triangulation icosahedron() {
  const double g = (1 + std::sqrt(5.0)) / 2;
  Triangulation mesh;
  for (const double s : {1.0, -1.0})
    for (const double t : {g, -g}) {
      mesh.vertices.push_back(Vector3(0, s, t).normalized());
      mesh.vertices.push_back(Vector3(s, t, 0).normalized());
      mesh.vertices.push_back(Vector3(t, 0, s).normalized());
    }
  // Neighbours: vertices with the largest inner product below 1. Triangles: triples of neighbours.
  const auto touching = [&](int a, int b) { return mesh.vertices[a].dot(mesh.vertices[b]) > 0.4; };
  for (int a = 0; a < 12; ++a)
    for (int b = a + 1; b < 12; ++b)
      for (int c = b + 1; c < 12; ++c) {
        if (!touching(a, b) || !touching(b, c) || !touching(c, a)) continue;
        const Vector3& p = mesh.vertices[a];
        const Vector3& q = mesh.vertices[b];
        const Vector3& r = mesh.vertices[c];
        const bool outward = (q - p).cross(r - p).dot(p) > 0;
        mesh.triangles.push_back(outward ? Eigen::Vector3i(a, b, c) : Eigen::Vector3i(a, c, b));
      }
  return mesh;
}

Triangulation bisected(Triangulation mesh) {
  std::map<std::pair<int, int>, int> midpoints;
  const auto midpoint = [&](int a, int b) {
    const auto [entry, is_new] =
        midpoints.try_emplace(std::minmax(a, b), static_cast<int>(mesh.vertices.size()));
    if (is_new) mesh.vertices.push_back((mesh.vertices[a] + mesh.vertices[b]).normalized());
    return entry->second;
  };
  std::vector<Eigen::Vector3i> finer;
  finer.reserve(4 * mesh.triangles.size());
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const int ab = midpoint(t[0], t[1]);
    const int bc = midpoint(t[1], t[2]);
    const int ca = midpoint(t[2], t[0]);
    finer.emplace_back(t[0], ab, ca);
    finer.emplace_back(ab, t[1], bc);
    finer.emplace_back(ca, bc, t[2]);
    finer.emplace_back(ab, bc, ca);
  }
  mesh.triangles = std::move(finer);
  return mesh;
}

}  // namespace

Triangulation geodesicSphere(int level) {
  Triangulation mesh = icosahedron();
  for (int i = 0; i < level; ++i) mesh = bisected(std::move(mesh));
  return mesh;
}

Triangulation geodesicEllipsoid(const Vector3& semi_axes, int level, const Matrix3& turn) {
  Triangulation mesh = geodesicSphere(level);
  for (Vector3& vertex : mesh.vertices) vertex = (turn * vertex).cwiseProduct(semi_axes);
  return mesh;
}

FaceTable faceTableOf(const Triangulation& mesh) {
  FaceTable faces;
  faces.reserve(mesh.triangles.size());
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const Vector3& a = mesh.vertices[t[0]];
    const Vector3& b = mesh.vertices[t[1]];
    const Vector3& c = mesh.vertices[t[2]];
    const Vector3 twice_area = (b - a).cross(c - a);
    const double length = twice_area.norm();
    faces.add(twice_area / length, (a + b + c) / 3, length / 2);
  }
  return faces;
}

double totalArea(const FaceTable& faces) {
  double sum = 0;
  for (const double area : faces.area) sum += area;
  return sum;
}

double referenceLength(const FaceTable& faces) { return std::sqrt(totalArea(faces)); }

}  // namespace ambient::test
