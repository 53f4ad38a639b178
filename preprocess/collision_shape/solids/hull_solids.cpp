#include "preprocess/collision_shape/solids/hull_solids.h"

#include <algorithm>
#include <cmath>

#include "preprocess/mesh/input_error.h"
#include "preprocess/mesh/mass_properties.h"
#include "preprocess/mesh/shapes/convex_hull.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "preprocess/potential_flow/surface/surface_refinement.h"

namespace ambient {
namespace {

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

Solid makeHullSolid(const Hull& hull, const SolidResolution& resolution, const std::string& name) {
  // Hulls of more triangles than those of 64 points, which convex decompositions make, are taken
  // for round bodies that their points lie on.
  constexpr Eigen::Index kMostOfPolyhedron = 124;
  const TriangleMesh mesh = hullOf(hull.points, name);
  Solid solid = solidOf(evenlyDivided(mesh, resolution.faces));
  solid.is_polyhedron = mesh.triangleCount() <= kMostOfPolyhedron;
  return solid;
}

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

}  // namespace ambient
