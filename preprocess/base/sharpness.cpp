#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/base/single_precision.h"
#include "preprocess/base/surface_form.h"
#include "preprocess/base/surface_triangles.h"

namespace ambient {
namespace {

/// Normals at the vertices of a mesh.
class VertexNormals {
 public:
  explicit VertexNormals(const SurfaceTriangles& mesh)
      : mesh_(mesh), stars_(static_cast<std::size_t>(mesh.vertexCount())) {
    for (int t = 0; t < mesh.size(); ++t)
      for (int corner = 0; corner < 3; ++corner)
        stars_[static_cast<std::size_t>(mesh.vertex(t, corner))].push_back({t, weight(t, corner)});
  }

  /// Weighted mean normal at a vertex, over the adjacent faces that `triangle` continues smoothly.
  Vector3 normal(int vertex, int triangle) const {
    Vector3 sum = Vector3::Zero();
    for (const Face& face : stars_[static_cast<std::size_t>(vertex)])
      if (mesh_.normal(face.triangle).dot(mesh_.normal(triangle)) >= kEdgeCosine)
        sum += face.weight * mesh_.normal(face.triangle);
    const double length = sum.norm();
    return length > 0 ? Vector3(sum / length) : mesh_.normal(triangle);
  }

 private:
  struct Face {
    int triangle;
    double weight;
  };

  /// Weight that makes the mean normal exact for every mesh inscribed in a sphere; Max 1999.
  double weight(int t, int corner) const {
    const auto edgeTo = [&](int other) {
      return Vector3(mesh_.place(mesh_.vertex(t, (corner + other) % 3)) -
                     mesh_.place(mesh_.vertex(t, corner)));
    };
    const Vector3 a = edgeTo(1), b = edgeTo(2);
    const double weight = a.cross(b).norm() / (a.squaredNorm() * b.squaredNorm());
    return std::isfinite(weight) ? weight : 0;  // a triangle without area
  }

  const SurfaceTriangles& mesh_;
  std::vector<std::vector<Face>> stars_;
};

struct Curvatures {
  double smallest = 0, largest = 0;  ///< principal curvatures, positive if convex [1/m]
};

/// Eigenvalues of the symmetric 2x2 matrix II with dn = II de along the edges, by least squares.
Curvatures curvaturesOf(const SurfaceTriangles& mesh, const VertexNormals& normals, int t) {
  const auto place = [&](int corner) { return mesh.place(mesh.vertex(t, corner)); };
  const Vector3 normal = mesh.normal(t);
  const Vector3 x_axis = (place(1) - place(0)).normalized();
  const Vector3 y_axis = normal.cross(x_axis);
  Matrix3 squares = Matrix3::Zero();
  Vector3 right = Vector3::Zero();
  for (int corner = 0; corner < 3; ++corner) {
    const int next = (corner + 1) % 3;
    const Vector3 edge = place(next) - place(corner);
    const Vector3 turn =
        normals.normal(mesh.vertex(t, next), t) - normals.normal(mesh.vertex(t, corner), t);
    const double u = edge.dot(x_axis), v = edge.dot(y_axis);
    const Vector3 rows[2] = {{u, v, 0}, {0, u, v}};  // coefficients of (II_xx, II_xy, II_yy)
    const double values[2] = {turn.dot(x_axis), turn.dot(y_axis)};
    for (int row = 0; row < 2; ++row) {
      squares += rows[row] * rows[row].transpose();
      right += values[row] * rows[row];
    }
  }
  const Vector3 form = squares.inverse() * right;
  const double mean = (form[0] + form[2]) / 2;
  const double spread = portable::hypot((form[0] - form[2]) / 2, form[1]);
  if (!std::isfinite(mean) || !std::isfinite(spread)) return {};  // a triangle without area
  return {mean - spread, mean + spread};
}

}  // namespace

double sharpnessOf(double curvature, double radius) {
  const double x = std::max(curvature, 0.0) * radius;
  const double root = 1 - 2 / (1 + 1 / (x * x));  // (1 - x^2) / (1 + x^2), never overflows
  return roundedToSingle(root * root);
}

std::vector<double> computeSharpness(const FluidBody& body) {
  if (body.surface.triangles.empty()) return std::vector<double>(body.faces.size(), 1);
  const SurfaceTriangles mesh(body);
  const VertexNormals normals(mesh);
  const double radius = std::sqrt(body.area / (4 * kPi));
  std::vector<double> front, back;
  for (int t = 0; t < mesh.size(); ++t) {
    const Curvatures curvatures = curvaturesOf(mesh, normals, t);
    front.push_back(sharpnessOf(curvatures.largest, radius));
    if (mesh.isSheet()) back.push_back(sharpnessOf(-curvatures.smallest, radius));
  }
  front.insert(front.end(), back.begin(), back.end());
  return front;
}

}  // namespace ambient
