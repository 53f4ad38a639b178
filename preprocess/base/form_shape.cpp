#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <vector>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/spatial/symmetric_eigen.h"
#include "preprocess/base/surface_form.h"
#include "preprocess/base/surface_triangles.h"

namespace ambient {
namespace {

constexpr double kPitchRelief = 0.4;  // p: part of the pitching that lift does not feel

double square(double x) { return x * x; }
double positivePart(double x) { return std::max(x, 0.0); }

/// Side of an edge: a triangle, and its corner that is not on the edge.
struct EdgeSide {
  int low, high;  ///< ends of the edge
  int triangle, corner;

  bool isOfEdgeOf(const EdgeSide& other) const { return low == other.low && high == other.high; }
};

/// The sides of all edges, those of one edge next to each other.
std::vector<EdgeSide> edgeSidesOf(const SurfaceTriangles& mesh) {
  std::vector<EdgeSide> sides;
  sides.reserve(3 * static_cast<std::size_t>(mesh.size()));
  for (int t = 0; t < mesh.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax({mesh.vertex(t, k), mesh.vertex(t, (k + 1) % 3)});
      sides.push_back({low, high, t, mesh.vertex(t, (k + 2) % 3)});
    }
  std::sort(sides.begin(), sides.end(), [](const EdgeSide& a, const EdgeSide& b) {
    return std::tie(a.low, a.high, a.triangle, a.corner) <
           std::tie(b.low, b.high, b.triangle, b.corner);
  });
  return sides;
}

/// True of a border, and of a convex edge sharper than 50 degrees; `sides`: the `count` sides of an
/// edge.
bool isSharp(const SurfaceTriangles& mesh, const EdgeSide* sides, std::size_t count) {
  constexpr double kSharpCosine = 0.64278761;  // cos 50 degrees
  if (count != 2) return count == 1;
  const Vector3& normal = mesh.normal(sides[0].triangle);
  const Vector3 across = mesh.place(sides[1].corner) - mesh.place(sides[0].low);
  return across.dot(normal) < 0 && normal.dot(mesh.normal(sides[1].triangle)) < kSharpCosine;
}

/// E of eq. (45c). `borders_count`: false of a part, whose borders are joints.
double edgeShare(const FluidBody& body, const SurfaceTriangles& mesh, bool borders_count) {
  if (mesh.size() == 0 || mesh.isSheet()) return 1;
  double length = 0;
  const std::vector<EdgeSide> sides = edgeSidesOf(mesh);
  for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    while (end < sides.size() && sides[end].isOfEdgeOf(sides[begin])) ++end;
    if (end - begin == 1 && !borders_count) continue;
    if (isSharp(mesh, &sides[begin], end - begin))
      length += (mesh.place(sides[begin].low) - mesh.place(sides[begin].high)).norm();
  }
  return square(length) / (square(length) + body.area);
}

/// Means over the area.
struct SurfaceMoments {
  Matrix3 places = Matrix3::Zero();   ///< (z - z_0)(z - z_0)^T [m^2], z_0: mean place
  Matrix3 normals = Matrix3::Zero();  ///< n n^T
};

/// Mean of (z - c)(z - c)^T over a triangle with the barycentre c [m^2].
Matrix3 spreadOf(const SurfaceTriangles& mesh, int triangle) {
  const auto corner = [&](int k) { return mesh.place(mesh.vertex(triangle, k)); };
  const Vector3 centre = (corner(0) + corner(1) + corner(2)) / 3;
  Matrix3 spread = Matrix3::Zero();
  for (int k = 0; k < 3; ++k)
    spread += (corner(k) - centre) * (corner(k) - centre).transpose() / 12;
  return spread;
}

/// Integrates over the triangles of `mesh`; faces without triangles count as points.
SurfaceMoments momentsOf(const FaceTable& faces, const SurfaceTriangles& mesh) {
  Vector3 mean = Vector3::Zero();
  double area = 0;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    mean += faces.area[i] * faces.centroid(i);
    area += faces.area[i];
  }
  mean /= area;
  SurfaceMoments moments;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const Vector3 c = faces.centroid(i) - mean, n = faces.normal(i);
    const double share = faces.area[i] / area;
    moments.places += share * c * c.transpose();
    moments.normals += share * n * n.transpose();
    if (mesh.size() > 0)
      moments.places += share * spreadOf(mesh, static_cast<int>(i) % mesh.size());
  }
  return moments;
}

/// The triangles of a body's surface; none: it has no surface.
SurfaceTriangles trianglesOf(const FluidBody& body) {
  return body.surface.triangles.empty() ? SurfaceTriangles(Surface{}) : SurfaceTriangles(body);
}

/// Fills in the mean plane with its span, aspect ratio and chord, eq. (45b). Returns
/// false for faces on one line, which have no chord.
bool setPlane(const SurfaceMoments& moments, FormShape& shape) {
  const SymmetricEigen<3> extent = symmetricEigen<3>(moments.places);
  if (!(extent.values[1] > 0)) return false;
  shape.facing = symmetricEigen<3>(moments.normals).vectors.col(2);
  shape.span = extent.vectors.col(2);
  shape.span -= shape.facing.dot(shape.span) * shape.facing;
  shape.span = shape.span.norm() > 0 ? Vector3(shape.span.normalized()) : Vector3::Zero();
  shape.chord = std::sqrt(12 * extent.values[1]);
  shape.aspect = std::sqrt(extent.values[2] / extent.values[1]);
  shape.pitching = std::sqrt(kPitchRelief * (1 - 1 / square(shape.aspect))) * shape.span;
  return true;
}

}  // namespace

FormShape formShapeOf(const FluidBody& body, bool borders_count) {
  FormShape shape;
  shape.centre = body.centre_of_volume;
  const SymmetricEigen<3> mass = symmetricEigen<3>(body.added_mass.bottomRightCorner<3, 3>());
  const double largest = mass.values[2];
  if (!(largest > 0) || !(body.area > 0) || body.faces.size() == 0) return shape;
  const SurfaceTriangles mesh = trianglesOf(body);
  const SurfaceMoments moments = momentsOf(body.faces, mesh);
  if (!setPlane(moments, shape)) return shape;
  const double aside = 1.5 * (1 - symmetricEigen<3>(moments.normals).values[2]);
  shape.wing =
      square(positivePart(1 - square(body.volume / largest))) * positivePart(1 - square(aside));
  shape.edges = edgeShare(body, mesh, borders_count);
  const double smooth = positivePart(1 - 2 * shape.edges);
  const double slender = positivePart(mass.values[1] - mass.values[0]) / mass.values[1];
  if (mass.values[1] > 0)
    shape.slender = std::sqrt(smooth * (1 - shape.wing) * slender) * mass.vectors.col(0);
  AMBIENT_ASSERT(shape.wing >= 0 && shape.wing <= 1 && shape.edges >= 0 && shape.edges <= 1);
  return shape;
}

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

namespace {

/// Sharpness of each triangle, for the back of a sheet after that for its front. `radius`: of the
/// sphere of the same area [m].
std::vector<double> sharpnessByTriangle(const SurfaceTriangles& mesh, double radius) {
  const VertexNormals normals(mesh);
  std::vector<double> front, back;
  for (int t = 0; t < mesh.size(); ++t) {
    const Curvatures curvatures = curvaturesOf(mesh, normals, t);
    front.push_back(sharpnessOf(curvatures.largest, radius));
    if (mesh.isSheet()) back.push_back(sharpnessOf(-curvatures.smallest, radius));
  }
  front.insert(front.end(), back.begin(), back.end());
  return front;
}

}  // namespace

std::vector<double> computeSharpness(const FluidBody& body) {
  if (body.surface.triangles.empty()) return std::vector<double>(body.faces.size(), 1);
  const WholeSides whole(body);
  const SurfaceTriangles& mesh = whole.mesh;
  const std::vector<double> of_whole = sharpnessByTriangle(mesh, std::sqrt(body.area / (4 * kPi)));
  const auto count = static_cast<std::size_t>(whole.count);
  std::vector<double> of_parts;
  of_parts.reserve(body.faces.size());
  for (auto value = of_whole.begin(); value < of_whole.end();) {
    std::vector<double> sum(count), area(count);
    for (int t = 0; t < mesh.size(); ++t) {
      const auto side = static_cast<std::size_t>(whole.side[static_cast<std::size_t>(t)]);
      sum[side] += mesh.area(t) * *value++;
      area[side] += mesh.area(t);
    }
    for (const int part : whole.parts) {
      const auto side = static_cast<std::size_t>(part);
      of_parts.push_back(area[side] > 0 ? roundedToSingle(sum[side] / area[side]) : 1);
    }
  }
  return of_parts;
}

}  // namespace ambient
