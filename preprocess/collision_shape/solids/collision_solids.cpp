#include "preprocess/collision_shape/solids/collision_solids.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "bullet_ambient/spatial/inertia.h"
#include "preprocess/mesh/graded_grid.h"
#include "preprocess/mesh/input_error.h"
#include "preprocess/mesh/mass_properties.h"
#include "preprocess/mesh/shapes/convex_hull.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "preprocess/mesh/weld_vertices.h"
#include "preprocess/mesh/wrap/surface_wrap.h"
#include "preprocess/potential_flow/surface/surface_refinement.h"

namespace ambient {
namespace {

Solid placed(Solid solid, const Matrix3& rotation, const Vector3& translation) {
  for (TriangleMesh* mesh : {&solid.mesh, &solid.flow, &solid.coarse_flow, &solid.cavities}) {
    mesh->vertices = (rotation * mesh->vertices).colwise() + translation;
  }
  if (solid.added_mass)
    solid.added_mass = shiftOrigin(rotateAxes(*solid.added_mass, rotation), -translation);
  return solid;
}

/// Makes a mesh of triangles with corners of their own.
TriangleMesh joinTriangles(const std::vector<Eigen::Vector3d>& corners) {
  std::vector<Eigen::Vector3i> triangles;
  for (int i = 0; i + 2 < static_cast<int>(corners.size()); i += 3) {
    triangles.emplace_back(i, i + 1, i + 2);
  }
  const TriangleMesh mesh = makeTriangleMesh(corners, triangles);
  if (corners.empty()) return mesh;
  constexpr double kWeld = 1e-6;
  return weldVertices(mesh, kWeld * mesh.extents().norm());
}

using Points = std::vector<Eigen::Vector3d>;

TriangleMesh hullOf(const Points& points, const std::string& name) {
  const auto count = static_cast<Eigen::Index>(points.size());
  const double* first = points.empty() ? nullptr : points.front().data();
  return makeConvexHull(Eigen::Map<const Eigen::Matrix3Xd>(first, 3, count), name, kCoarseHullBits);
}

void requireSize(const std::string& name, const char* what, double value) {
  if (std::isfinite(value) && value > 0) return;
  raiseInputError(name, what, " = ", value, " m must be positive and finite");
}

double volumeOf(const TriangleMesh& mesh) { return computeMassProperties(mesh).volume; }

/// Directions of the vertices of a geodesic sphere of 20 n^2 triangles.
TriangleMesh directions(int n) { return makeEllipsoidMesh({1, 1, 1}, 20 * n * n); }

TriangleMesh ballHull(const BallHull& hull, int n, const std::string& name) {
  const TriangleMesh sphere = directions(n);
  Points points;
  for (const BallHull::Ball& ball : hull.balls) {
    for (Eigen::Index d = 0; d < sphere.vertexCount(); ++d) {
      points.emplace_back(ball.centre + ball.semi_axes.cwiseProduct(sphere.vertices.col(d)));
    }
  }
  return hullOf(points, name);
}

Solid solidOf(const TriangleMesh& mesh) {
  Solid solid;
  solid.mesh = mesh;
  return solid;
}

/// Largest n so that a geodesic sphere has at most that many triangles.
int frequencyFor(int faces) { return std::max(2, static_cast<int>(std::sqrt(faces / 20.0))); }

/// Makes the solid of a hull.
Solid makeHullSolid(const Hull& hull, const SolidResolution& resolution, const std::string& name) {
  Solid solid = solidOf(evenlyDivided(hullOf(hull.points, name), resolution.faces));
  solid.is_polyhedron = true;
  return solid;
}

/// Makes the solid of the hull of several ellipsoids; its volume is extrapolated from two
/// approximations by polyhedra.
Solid makeBallHullSolid(const BallHull& hull, const SolidResolution& resolution,
                        const std::string& name) {
  for (const BallHull::Ball& ball : hull.balls)
    for (const double radius : ball.semi_axes) requireSize(name, "the radius of a sphere", radius);
  // The other half of the triangles is for what lies between the balls.
  const int n = frequencyFor(resolution.faces / 2), fine = frequencyFor(resolution.flow_faces / 2);
  const TriangleMesh coarse_hull = ballHull(hull, n, name);
  if (fine <= n) return solidOf(evenlyDivided(coarse_hull, resolution.faces));
  const TriangleMesh fine_hull = ballHull(hull, fine, name);
  // The missing volume shrinks with the square of the triangles' size, and so does the error.
  const double ratio = static_cast<double>(fine * fine) / (n * n);
  const double volume =
      volumeOf(fine_hull) + (volumeOf(fine_hull) - volumeOf(coarse_hull)) / (ratio - 1);
  Solid solid;
  solid.mesh = evenlyDivided(withVolume(coarse_hull, volume), resolution.faces);
  solid.coarse_flow = solid.mesh;
  solid.flow = evenlyDivided(withVolume(fine_hull, volume), resolution.flow_faces);
  solid.flow_ratio = ratio;
  return solid;
}

/// Makes the solid of each kind of shape, about its own origin.
struct SolidMaker {
  const SolidResolution& resolution;
  const std::string& name;

  Solid operator()(const Hull& hull) const { return makeHullSolid(hull, resolution, name); }

  Solid operator()(const BallHull& hull) const {
    if (hull.balls.size() > 1) return makeBallHullSolid(hull, resolution, name);
    const auto& [centre, semi_axes] = hull.balls.front();
    const bool is_sphere = semi_axes == Eigen::Vector3d::Constant(semi_axes[0]);
    const Solid ball = is_sphere ? (*this)(Sphere{semi_axes[0]}) : (*this)(Ellipsoid{semi_axes});
    return placed(ball, Matrix3::Identity(), centre);
  }

  Solid operator()(const TriangleSoup& soup) const {
    CheckedMesh checked =
        makeBodyMesh(joinTriangles(soup.corners), name, resolution.strict, resolution.unit);
    Solid solid;
    solid.mesh = std::move(checked.mesh);
    solid.cavities = std::move(checked.cavities);
    solid.warnings = std::move(checked.warnings);
    return solid;
  }

  /// Shapes that follow from a few numbers.
  template <class Simple>
  Solid operator()(const Simple& shape) const {
    requireUsualExtents(shape, 1, name);
    const ShapeFacts facts = factsOf(shape);
    const auto known = facts.added_mass(1);
    Solid solid;
    if (known && (resolution.tables || !known->is_tabulated)) solid.added_mass = known->added_mass;
    solid.sphere_radius = facts.sphere_radius;
    solid.is_polyhedron = std::is_same_v<Simple, Box>;
    const int faces = std::max(resolution.faces, facts.least_faces());
    solid.mesh = facts.mesh(faces);
    if (solid.added_mass || !facts.is_smooth || resolution.flow_faces <= faces) return solid;
    const TriangleMesh fine = facts.mesh(resolution.flow_faces);
    if (fine.triangleCount() <= solid.mesh.triangleCount()) return solid;
    solid.flow = fine;
    solid.coarse_flow = solid.mesh;
    solid.flow_ratio =
        static_cast<double>(fine.triangleCount()) / static_cast<double>(solid.mesh.triangleCount());
    return solid;
  }
};

}  // namespace

TriangleMesh evenlyDivided(const TriangleMesh& mesh, int faces) {
  constexpr double kLongest = 2.5, kLonger = 1.4;
  double longest =
      kLongest * std::sqrt(4 / std::sqrt(3.0) * computeMassProperties(mesh).area / faces);
  const auto limit = std::max<Eigen::Index>(2 * faces, mesh.triangleCount());
  TriangleMesh divided = divideLongEdges(mesh, longest);
  while (divided.triangleCount() > limit) divided = divideLongEdges(mesh, longest *= kLonger);
  return divided;
}

std::optional<Matrix6> tabulatedAddedMass(const Shape& shape) {
  const auto known = factsOf(shape).added_mass(1);
  return known && known->is_tabulated ? std::optional(known->added_mass) : std::nullopt;
}

std::vector<Solid> makeSolids(const std::vector<PlacedShape>& parts,
                              const SolidResolution& resolution) {
  const int count = std::max(1, static_cast<int>(parts.size()));
  constexpr int kFewestFaces = 20;  // that all kinds can be made of
  SolidResolution each = resolution;
  each.least_faces = std::min(resolution.least_faces,
                              std::max(kFewestFaces, kMostOfMany * resolution.faces / count));
  each.faces = std::max(each.least_faces, resolution.faces / count);
  each.flow_faces = std::max(each.faces, resolution.flow_faces / count);
  std::vector<Solid> solids;
  for (const PlacedShape& part : parts) {
    solids.push_back(placed(std::visit(SolidMaker{each, part.name}, part.shape), part.pose.linear(),
                            part.pose.translation()));
    solids.back().name = part.name;
  }
  return solids;
}

}  // namespace ambient
