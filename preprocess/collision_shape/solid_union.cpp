#include "preprocess/collision_shape/solid_union.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "preprocess/collision_shape/convex_solids.h"
#include "preprocess/collision_shape/hull_mesh.h"
#include "preprocess/collision_shape/quick_added_mass.h"
#include "preprocess/collision_shape/solid_contact.h"
#include "preprocess/mesh/crack_mending.h"
#include "preprocess/mesh/graded_grid.h"
#include "preprocess/mesh/input_error.h"
#include "preprocess/mesh/join_meshes.h"
#include "preprocess/mesh/mass_properties.h"
#include "preprocess/mesh/mesh_checks.h"
#include "preprocess/mesh/mesh_mending.h"
#include "preprocess/mesh/mesh_topology.h"
#include "preprocess/mesh/polygon_triangles.h"
#include "preprocess/mesh/solid_tree.h"
#include "preprocess/mesh/weld_vertices.h"
#include "preprocess/potential_flow/flat_merging.h"

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {
namespace {

using Meshes = std::vector<TriangleMesh>;

// Of the size of the whole: what places and sizes of a form are rounded by, with room.
constexpr double kOnPlane = 5e-6, kWelded = 4 * kOnPlane;

/// The corners at which a polygon turns. What lies between them comes back where others need it,
/// as the end of a crack.
std::vector<Eigen::Vector3d> turningCorners(const FlatPolygon& polygon, double tolerance) {
  std::vector<Eigen::Vector3d> corners = polygon.corners;
  for (std::size_t i = 0; i < corners.size() && corners.size() > 2;) {
    const Eigen::Vector3d before = corners[(i + corners.size() - 1) % corners.size()];
    const Eigen::Vector3d along = corners[(i + 1) % corners.size()] - before;
    const double height = along.stableNormalized().cross(corners[i] - before).norm();
    if (height > tolerance) {
      ++i;
    } else {
      corners.erase(corners.begin() + static_cast<std::ptrdiff_t>(i));
    }
  }
  return corners;
}

/// The convex polygons as triangles, vertices welded.
TriangleMesh meshOf(const std::vector<FlatPolygon>& polygons, double weld) {
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector3i> triangles;
  for (const FlatPolygon& polygon : polygons) {
    const std::vector<Eigen::Vector3d> corners = turningCorners(polygon, weld);
    if (corners.size() < 3) continue;
    const int first = static_cast<int>(points.size());
    points.insert(points.end(), corners.begin(), corners.end());
    for (const Eigen::Vector3i& t : dividePolygon(corners)) {
      triangles.emplace_back(t.array() + first);
    }
  }
  return weldVertices(makeTriangleMesh(points, triangles), weld);
}

/// Without triangles that have a corner twice, flat ones (which the next round of stitching
/// replaces), and pairs on the same corners, one each way round.
TriangleMesh withoutSlivers(const TriangleMesh& mesh) {
  std::map<std::array<int, 3>, std::vector<int>> by_corners;
  for (const SortedTriangle& t : sortedByCorners(mesh)) by_corners[t.corners].push_back(t.triangle);
  std::vector<int> kept;
  for (const auto& [corners, found] : by_corners) {
    const bool is_sliver = corners[0] == corners[1] || corners[1] == corners[2] ||
                           heightRatio(mesh, found.front()) < kLeastHeight;
    if (!is_sliver && found.size() % 2 == 1) kept.push_back(found.front());
  }
  std::sort(kept.begin(), kept.end());
  TriangleMesh result = mesh;
  result.triangles = mesh.triangles(Eigen::all, kept);
  return result;
}

TriangleMesh stitched(TriangleMesh mesh, double tolerance) {
  constexpr int kMostRounds = 6;
  for (int round = 0; round < kMostRounds; ++round) {
    mesh = withoutCracks(mesh, tolerance);
    TriangleMesh without = withoutSlivers(mesh);
    if (without.triangleCount() == mesh.triangleCount()) break;
    mesh = std::move(without);
  }
  return mesh;
}

/// The surface of the union, closed if nothing went wrong.
TriangleMesh unionSurface(const Meshes& parts, double size) {
  std::vector<SolidTree> trees;
  for (const TriangleMesh& part : parts) trees.emplace_back(part, kOnPlane * size);
  std::vector<FlatPolygon> surface;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    std::vector<FlatPolygon> left = polygonsOf(parts[i]);
    for (std::size_t j = 0; j < parts.size(); ++j) {
      if (i == j) continue;
      std::vector<FlatPolygon> next;
      for (const FlatPolygon& polygon : left) {
        const std::vector<FlatPolygon> pieces = trees[j].cutOff(polygon, i < j);
        next.insert(next.end(), pieces.begin(), pieces.end());
      }
      left = std::move(next);
    }
    surface.insert(surface.end(), left.begin(), left.end());
  }
  return stitched(meshOf(surface, kWelded * size), kWelded * size);
}

TriangleMesh blownUp(TriangleMesh mesh, double share) {
  const Eigen::Vector3d centre =
      (mesh.vertices.rowwise().maxCoeff() + mesh.vertices.rowwise().minCoeff()) / 2;
  mesh.vertices += share * (mesh.vertices.colwise() - centre);
  return mesh;
}

Meshes componentsOf(const TriangleMesh& mesh) {
  const MeshComponents components = computeMeshComponents(mesh, computeMeshEdges(mesh));
  Meshes parts(static_cast<std::size_t>(components.count));
  for (int c = 0; c < components.count; ++c) {
    std::vector<Eigen::Index> own;
    for (Eigen::Index t = 0; t < mesh.triangleCount(); ++t) {
      if (components.component_of[static_cast<std::size_t>(t)] == c) own.push_back(t);
    }
    TriangleMesh& part = parts[static_cast<std::size_t>(c)];
    part.vertices = mesh.vertices;
    part.triangles = mesh.triangles(Eigen::all, own);
    part = weldVertices(part, 0);
  }
  return parts;
}

double volumeOf(const Meshes& parts) {
  double sum = 0;
  for (const TriangleMesh& part : parts) sum += computeMassProperties(part).volume;
  return sum;
}

void requireGaps(const TriangleMesh& mesh) {
  const Meshes parts = componentsOf(mesh);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (areInContact(parts[i], parts[j]))
        throw std::runtime_error("a gap between them is too narrow for the flow");
    }
  }
}

/// Sides that are cut off remain a surface of the right volume only if every cut was.
void requireVolume(const TriangleMesh& mesh, const Meshes& parts) {
  constexpr double kTolerance = 5e-3;
  const double volume = computeMassProperties(mesh).volume;
  double largest = 0;
  for (const TriangleMesh& part : parts)
    largest = std::max(largest, computeMassProperties(part).volume);
  if (volume >= (1 - kTolerance) * largest && volume <= (1 + kTolerance) * volumeOf(parts)) return;
  throw std::runtime_error("the surface of their union has a volume of its own");
}

CheckedMesh uniteMeshes(const Meshes& parts, const std::string& name) {
  std::string reason;
  for (const double share : {0.0, 3e-4, 1.2e-3}) {
    try {
      Meshes blown_up;
      for (const TriangleMesh& part : parts) blown_up.push_back(blownUp(part, share));
      const double size = joinMeshes(blown_up).extents().norm();
      CheckedMesh united = checkMesh(unionSurface(blown_up, size), name);
      requireVolume(united.mesh, blown_up);
      requireGaps(united.mesh);
      united.warnings.clear();  // of what came of cutting
      return united;
    } catch (const std::runtime_error& error) {
      if (reason.empty()) reason = error.what();
    }
  }
  throw std::runtime_error(reason);
}

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

std::string namesOf(const std::vector<Solid>& solids) {
  return solids.front().part + " and " + solids[1].part +
         (solids.size() > 2 ? " and " + std::to_string(solids.size() - 2) + " more" : "");
}

Solid uniteGroup(const std::vector<Solid>& group, const CollisionShapeSettings& settings,
                 const std::string& name) {
  Meshes parts, cavities;
  Matrix6 parts_added_mass = Matrix6::Zero();
  Solid solid;
  for (const Solid& own : group) {
    parts.push_back(mergeFlatTriangles(own.mesh, false, kDefaultPanels));
    cavities.push_back(own.cavities);
    parts_added_mass += quickAddedMass(own);
    solid.margin_volume += own.margin_volume;
    solid.warnings.insert(solid.warnings.end(), own.warnings.begin(), own.warnings.end());
  }
  const CheckedMesh united = uniteMeshes(parts, name);
  cavities.push_back(united.cavities);
  solid.mesh = evenlyDivided(united.mesh, settings.faces);
  solid.cavities = joinMeshes(cavities);
  // What lies in two of them counts once.
  solid.parts_added_mass =
      parts_added_mass * (computeMassProperties(united.mesh).volume / volumeOf(parts));
  return solid;
}

Solid hullOf(const std::vector<Solid>& group, const CollisionShapeSettings& settings,
             const std::string& reason, const std::string& name) {
  std::vector<Eigen::Vector3d> points;
  double sum = 0;
  for (const Solid& solid : group) {
    sum += computeMassProperties(solid.mesh).volume;
    for (Eigen::Index v = 0; v < solid.mesh.vertexCount(); ++v)
      points.emplace_back(solid.mesh.vertices.col(v));
  }
  Solid hull;
  hull.mesh = evenlyDivided(makeHullMesh(points, name), settings.faces);
  std::ostringstream text;
  text.precision(3);
  text << name << ": " << namesOf(group) << " cannot be united (" << reason
       << "): their convex hull stands for them, with "
       << 100 * (computeMassProperties(hull.mesh).volume / sum - 1)
       << " % more volume than their sum; added mass is off by as much or more";
  hull.warnings.push_back(text.str());
  return hull;
}

void keepSum(std::vector<Solid> group, const std::string& reason, const std::string& name,
             SeparateSolids& result) {
  group.front().warnings.push_back(
      name + ": " + namesOf(group) + " cannot be united (" + reason +
      "): the sum of what each has alone stands for them; volume is counted twice where they "
      "overlap, and added mass may be off by tens of per cent");
  result.solids.insert(result.solids.end(), group.begin(), group.end());
  result.is_sum = true;
}

[[noreturn]] void refuse(const std::vector<Solid>& group, const std::string& reason,
                         const std::string& name) {
  raiseInputError(name, namesOf(group), " touch or overlap and cannot be united (", reason,
                  "): make the fluid body of one closed mesh or one convex hull of them (the ",
                  "collision shape may stay as it is), or leave a gap of ", kLeastGap,
                  " of the smaller one's size");
}

}  // namespace

SeparateSolids uniteSolids(const std::vector<Solid>& solids, const CollisionShapeSettings& settings,
                           const std::string& name) {
  SeparateSolids result;
  for (const std::vector<Solid>& group : contactGroups(solids)) {
    if (group.size() == 1) {
      result.solids.push_back(group.front());
      continue;
    }
    try {
      result.solids.push_back(uniteGroup(group, settings, name));
    } catch (const std::runtime_error& error) {
      switch (settings.fallback) {
        case CompoundFallback::kHull:
          result.solids.push_back(hullOf(group, settings, error.what(), name));
          break;
        case CompoundFallback::kSum:
          keepSum(group, error.what(), name, result);
          break;
        case CompoundFallback::kRefuse:
          refuse(group, error.what(), name);
      }
    }
  }
  return result;
}

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
