#include "preprocess/collision_shape/solids/hull_solids.h"

#include <algorithm>
#include <cmath>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "preprocess/mesh/input_error.h"
#include "preprocess/mesh/mass_properties.h"
#include "preprocess/mesh/mesh_topology.h"
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

/// Sum of length times angle between the normals over all edges of a convex polyhedron, halved: the
/// integral of its mean curvature.
double meanCurvatureOf(const TriangleMesh& mesh) {
  double sum = 0;
  const MeshEdges edges = computeMeshEdges(mesh);
  for (const EdgeGroup& edge : edges.edges) {
    const HalfEdge& half = edges.half_edges[edge.first];
    const Eigen::Vector3d a = normalOf(mesh, half.triangle);
    const Eigen::Vector3d b = normalOf(mesh, edges.half_edges[edge.first + 1].triangle);
    sum += (mesh.vertices.col(half.low) - mesh.vertices.col(half.high)).norm() *
           portable::atan2(a.cross(b).norm(), a.dot(b));
  }
  return sum / 2;
}

/// Steiner's formula for the volume within `margin` of a convex polyhedron.
double volumeWithin(const TriangleMesh& hull, double margin) {
  const MeshProperties properties = computeMassProperties(hull);
  return properties.volume + margin * properties.area + margin * margin * meanCurvatureOf(hull) +
         4 * kPi / 3 * margin * margin * margin;
}

/// Directions of the vertices of a geodesic sphere of 20 n^2 triangles.
TriangleMesh directions(int n) { return makeEllipsoidMesh({1, 1, 1}, 20 * n * n); }

/// The hull's corners moved by the margin along the normals of their faces, so that faces stay flat
/// and come to lie where they should, and in the directions of a sphere, for the edges; n = 0: none
/// of these.
Points pointsWithin(const TriangleMesh& hull, double margin, int n) {
  Points points;
  for (Eigen::Index t = 0; t < hull.triangleCount(); ++t) {
    for (int k = 0; k < 3; ++k) points.emplace_back(hull.corner(t, k) + margin * normalOf(hull, t));
  }
  if (n == 0) return points;
  const TriangleMesh sphere = directions(n);
  for (Eigen::Index v = 0; v < hull.vertexCount(); ++v) {
    for (Eigen::Index d = 0; d < sphere.vertexCount(); ++d) {
      points.emplace_back(hull.vertices.col(v) + margin * sphere.vertices.col(d));
    }
  }
  return points;
}

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

Solid makeHullSolid(const Hull& shape, const SolidResolution& resolution, const std::string& name) {
  const TriangleMesh hull = hullOf(shape.points, name);
  const double margin = shape.margin;
  if (margin <= 0) return solidOf(evenlyDivided(hull, resolution.faces));
  requireSize(name, "the margin", margin);
  const double volume = volumeWithin(hull, margin);
  const auto roundedWith = [&](int n) {
    return withVolume(hullOf(pointsWithin(hull, margin, n), name), volume);
  };
  const double share = margin / hull.extents().minCoeff();
  // The more corners, the smaller the angles that are left to be rounded; and the narrower the
  // rounded edges, the less their form matters.
  constexpr double kNarrow = 0.05, kTiny = 0.01;
  const int fine = share < kTiny               ? 0
                   : hull.vertexCount() <= 30  ? 4
                   : hull.vertexCount() <= 100 ? 2
                                               : 0;
  const int coarse = std::min(fine, 2);
  Solid solid = solidOf(evenlyDivided(roundedWith(fine), resolution.faces));
  solid.margin_volume = volume - volumeOf(hull);
  if (resolution.flow_faces > solid.mesh.triangleCount()) {
    // All corners of the rounded hull lie on edges that are sharp from afar. Few directions on
    // narrow ones leave panels for the sides.
    const bool is_narrow = share < kNarrow;
    const TriangleMesh rounded = roundedWith(is_narrow ? coarse : fine);
    const int even = is_narrow ? resolution.flow_faces / 2 : resolution.faces;
    solid.flow = refineTowardsFirst(evenlyDivided(rounded, even), rounded.vertexCount(),
                                    resolution.flow_faces);
  }
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
