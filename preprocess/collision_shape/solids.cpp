#include "preprocess/collision_shape/solids.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "bullet_ambient/spatial/inertia.h"
#include "preprocess/builder/fluid_body_builder.h"
#include "preprocess/mesh/check/mesh_checks.h"
#include "preprocess/mesh/input_error.h"
#include "preprocess/mesh/mass_properties.h"
#include "preprocess/mesh/shapes/convex_hull.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "preprocess/mesh/triangle_mesh.h"
#include "preprocess/mesh/union/mesh_union.h"
#include "preprocess/mesh/wrap/surface_wrap.h"
#include "preprocess/potential_flow/surface/flat_merging.h"
#include "preprocess/potential_flow/surface/surface_refinement.h"

namespace ambient {

namespace {

Solid placed(Solid solid, const Matrix3& rotation, const Vector3& translation) {
  for (TriangleMesh* mesh : {&solid.mesh, &solid.flow, &solid.coarse_flow, &solid.cavities}) {
    mesh->vertices = (rotation * mesh->vertices).colwise() + translation;
  }
  for (std::optional<Matrix6>* known : {&solid.added_mass, &solid.viscous_flow.resistance})
    if (*known) *known = shiftOrigin(rotateAxes(**known, rotation), -translation);
  if (std::optional<Separation>& separation = solid.viscous_flow.separation)
    separation->axes = rotation * separation->axes;
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
    if (known && (resolution.tables || !known->is_tabulated)) {
      solid.added_mass = known->added_mass;
      solid.viscous_flow = facts.viscous_flow(1, known->added_mass);
    }
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
  const ShapeFacts facts = factsOf(shape);
  const bool has_size = facts.half_extents.allFinite() && (facts.half_extents.array() > 0).all();
  const auto known = has_size ? facts.added_mass(1) : std::nullopt;
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

namespace {

using Meshes = std::vector<TriangleMesh>;

/// Solids that hang together by contacts, in their order.
std::vector<std::vector<Solid>> contactGroups(const std::vector<Solid>& solids) {
  DisjointSets sets(solids.size());
  for (std::size_t i = 0; i < solids.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (areInContact(solids[i].mesh, solids[j].mesh))
        sets.join(static_cast<int>(i), static_cast<int>(j));
    }
  }
  std::map<int, std::vector<Solid>> by_set;
  for (std::size_t i = 0; i < solids.size(); ++i)
    by_set[sets.find(static_cast<int>(i))].push_back(solids[i]);
  std::vector<std::vector<Solid>> groups;
  for (auto& [set, group] : by_set) groups.push_back(std::move(group));
  return groups;
}

/// The first two by their places in the compound of that name.
std::string namesOf(const std::vector<Solid>& solids, const std::string& name) {
  const auto placeOf = [&](const Solid& solid) {
    const bool begins_with_it = solid.name.rfind(name + ": ", 0) == 0;
    return begins_with_it ? solid.name.substr(name.size() + 2) : solid.name;
  };
  return placeOf(solids[0]) + " and " + placeOf(solids[1]) +
         (solids.size() > 2 ? " and " + std::to_string(solids.size() - 2) + " more" : "");
}

/// The faces of a united group, one of several.
int facesOf(const std::vector<Solid>& group, std::size_t all, int faces) {
  const double share = static_cast<double>(group.size()) / static_cast<double>(all);
  return std::max(1, static_cast<int>(std::min(1.0, kMostOfMany * share) * faces));
}

/// The surface wrapped around parts; none if it has another volume than their union.
std::optional<CheckedMesh> wrapOf(const Meshes& parts, const std::string& name) {
  constexpr double kTolerance = 0.01;
  try {
    CheckedMesh wrap = wrapSurface(joinMeshes(parts), 0, name);
    const double volume = volumeOfUnion(parts);
    const double change = computeMassProperties(wrap.mesh).volume / volume - 1;
    if (!(std::abs(change) <= kTolerance)) return std::nullopt;
    wrap.mesh = withVolume(wrap.mesh, volume);
    return wrap;
  } catch (const std::runtime_error&) {
    return std::nullopt;
  }
}

/// The union of a group, or a wrap around it. Round parts of many triangles, which seldom can be
/// united, are wrapped before the tries that take seconds.
CheckedMesh unitedOrWrapped(const Meshes& parts, JoinedBy by, const std::string& name) {
  constexpr Eigen::Index kFewTriangles = 1500;
  const bool are_few = joinMeshes(parts).triangleCount() <= kFewTriangles;
  std::string reason;
  if (by == JoinedBy::kUnion) {
    try {
      return uniteMeshes(parts, name, are_few ? UnionTries::kAll : UnionTries::kOne);
    } catch (const std::runtime_error& error) {
      reason = error.what();
    }
  }
  if (std::optional<CheckedMesh> wrap = wrapOf(parts, name)) return *std::move(wrap);
  if (by == JoinedBy::kWrap || are_few) throw std::runtime_error(reason);
  return uniteMeshes(parts, name);
}

Solid uniteGroup(const std::vector<Solid>& group, int faces, JoinedBy by, const std::string& name) {
  Solid solid;
  Meshes parts, cavities;
  for (const Solid& own : group) {
    parts.push_back(own.is_polyhedron ? mergePolyhedronSides(own.mesh)
                                      : mergeFlatTriangles(own.mesh, false, kDefaultPanels));
    cavities.push_back(own.cavities);
    solid.warnings.insert(solid.warnings.end(), own.warnings.begin(), own.warnings.end());
  }
  const CheckedMesh surface = unitedOrWrapped(parts, by, name);
  cavities.push_back(surface.cavities);
  solid.is_polyhedron = arePolyhedra(group);
  solid.mesh = evenlyDivided(surface.mesh, faces);
  solid.cavities = joinMeshes(cavities);
  return solid;
}

/// The hull of points that may lie closer to each other, or in line, than a flow can resolve: those
/// closer than 1e-4 of the size become one.
TriangleMesh cleanHull(TriangleMesh cloud, const std::string& name) {
  constexpr double kWelded = 1e-4;
  cloud = weldVertices(cloud, kWelded * cloud.extents().norm());
  const TriangleMesh hull = makeConvexHull(cloud.vertices, name, kCoarseHullBits);
  return requireSound(checkMesh(hull, name), name).mesh;
}

Solid hullOf(const std::vector<Solid>& group, int faces, const std::string& reason,
             const std::string& name) {
  Meshes meshes;
  for (const Solid& solid : group) meshes.push_back(solid.mesh);
  const double sum = sumOfVolumes(meshes);
  Solid hull;
  hull.mesh = evenlyDivided(cleanHull(joinMeshes(meshes), name), faces);
  hull.is_polyhedron = arePolyhedra(group);
  std::ostringstream text;
  text.precision(3);
  text << name << ": " << namesOf(group, name) << " cannot be united (" << reason
       << "): their convex hull stands for them, with "
       << 100 * (computeMassProperties(hull.mesh).volume / sum - 1)
       << " % more volume than their sum; added mass is off by as much or more";
  hull.warnings.push_back(text.str());
  return hull;
}

}  // namespace

bool arePolyhedra(const std::vector<Solid>& solids) {
  return std::all_of(solids.begin(), solids.end(),
                     [](const Solid& solid) { return solid.is_polyhedron; });
}

SeparateSolids uniteSolids(const std::vector<Solid>& solids, int faces, const std::string& name,
                           JoinedBy by, const std::string& reason) {
  SeparateSolids result;
  for (const std::vector<Solid>& group : contactGroups(solids)) {
    if (group.size() == 1) {
      result.solids.push_back(group.front());
      continue;
    }
    std::string why = reason;
    try {
      if (by != JoinedBy::kHull) {
        result.solids.push_back(uniteGroup(group, facesOf(group, solids.size(), faces), by, name));
        result.are_joined = true;
        continue;
      }
    } catch (const std::runtime_error& error) {
      if (why.empty()) why = error.what();
    }
    result.solids.push_back(hullOf(group, faces, why, name));
  }
  return result;
}

}  // namespace ambient
