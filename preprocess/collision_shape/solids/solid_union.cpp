#include "preprocess/collision_shape/solids/solid_union.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "preprocess/builder/fluid_body_builder.h"
#include "preprocess/collision_shape/solids/collision_solids.h"
#include "preprocess/mesh/check/mesh_checks.h"
#include "preprocess/mesh/graded_grid.h"
#include "preprocess/mesh/input_error.h"
#include "preprocess/mesh/join_meshes.h"
#include "preprocess/mesh/mass_properties.h"
#include "preprocess/mesh/mesh_topology.h"
#include "preprocess/mesh/shapes/convex_hull.h"
#include "preprocess/mesh/union/mesh_union.h"
#include "preprocess/mesh/union/solid_contact.h"
#include "preprocess/mesh/weld_vertices.h"
#include "preprocess/mesh/wrap/surface_wrap.h"
#include "preprocess/potential_flow/surface/flat_merging.h"

namespace ambient {
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

/// The union of a group, or a wrap around it: for round parts of many triangles, which seldom can
/// be united, before the tries that take seconds.
Solid unitedOrWrapped(const Meshes& parts, bool polyhedra, const std::string& name) {
  constexpr Eigen::Index kFewTriangles = 1500;
  const bool are_few = joinMeshes(parts).triangleCount() <= kFewTriangles;
  Solid solid;
  solid.is_polyhedron = polyhedra;
  CheckedMesh surface;
  try {
    surface = uniteMeshes(parts, name, are_few ? UnionTries::kAll : UnionTries::kOne);
  } catch (const std::runtime_error&) {
    const std::optional<CheckedMesh> wrap = wrapOf(parts, name);
    if (!wrap && are_few) throw;
    surface = wrap ? *wrap : uniteMeshes(parts, name);
    solid.is_polyhedron = polyhedra && !wrap;
  }
  solid.mesh = std::move(surface.mesh);
  solid.cavities = std::move(surface.cavities);
  return solid;
}

Solid uniteGroup(const std::vector<Solid>& group, int faces, const std::string& name) {
  Meshes parts, cavities;
  std::vector<std::string> warnings;
  for (const Solid& own : group) {
    parts.push_back(own.is_polyhedron ? mergePolyhedronSides(own.mesh)
                                      : mergeFlatTriangles(own.mesh, false, kDefaultPanels));
    cavities.push_back(own.cavities);
    warnings.insert(warnings.end(), own.warnings.begin(), own.warnings.end());
  }
  Solid solid = unitedOrWrapped(parts, arePolyhedra(group), name);
  solid.warnings = std::move(warnings);
  cavities.push_back(solid.cavities);
  solid.mesh = evenlyDivided(solid.mesh, faces);
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

Solid hullOf(const std::vector<Solid>& group, const UnionSettings& settings,
             const std::string& reason, const std::string& name) {
  Meshes meshes;
  for (const Solid& solid : group) meshes.push_back(solid.mesh);
  const double sum = sumOfVolumes(meshes);
  Solid hull;
  hull.mesh = evenlyDivided(cleanHull(joinMeshes(meshes), name), settings.faces);
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

void keepSum(std::vector<Solid> group, const std::string& reason, const std::string& name,
             SeparateSolids& result) {
  group.front().warnings.push_back(
      name + ": " + namesOf(group, name) + " cannot be united (" + reason +
      "): the sum of what each has alone stands for them; volume is counted twice where they "
      "overlap, and added mass may be off by tens of per cent");
  result.solids.insert(result.solids.end(), group.begin(), group.end());
  result.is_sum = true;
}

[[noreturn]] void refuse(const std::vector<Solid>& group, const std::string& reason,
                         const std::string& name) {
  raiseInputError(name, namesOf(group, name), " touch or overlap and cannot be united (", reason,
                  "): make the fluid body of one closed mesh or one convex hull of them (the ",
                  "collision shape may stay as it is), or leave a gap of ", kLeastGap,
                  " of the smaller one's size");
}

/// Adds to `result` the replacement of a group that cannot be united, by the settings' fallback.
void fallBack(const std::vector<Solid>& group, const UnionSettings& settings,
              const std::string& reason, const std::string& name, SeparateSolids& result) {
  switch (settings.fallback) {
    case CompoundFallback::kHull:
      result.solids.push_back(hullOf(group, settings, reason, name));
      break;
    case CompoundFallback::kSum:
      keepSum(group, reason, name, result);
      break;
    case CompoundFallback::kRefuse:
      refuse(group, reason, name);
  }
}

}  // namespace

bool arePolyhedra(const std::vector<Solid>& solids) {
  return std::all_of(solids.begin(), solids.end(),
                     [](const Solid& solid) { return solid.is_polyhedron; });
}

SeparateSolids uniteSolids(const std::vector<Solid>& solids, const UnionSettings& settings,
                           const std::string& name) {
  SeparateSolids result;
  for (const std::vector<Solid>& group : contactGroups(solids)) {
    if (group.size() == 1) {
      result.solids.push_back(group.front());
      continue;
    }
    try {
      result.solids.push_back(
          uniteGroup(group, facesOf(group, solids.size(), settings.faces), name));
      result.has_unions = true;
    } catch (const std::runtime_error& error) {
      fallBack(group, settings, error.what(), name, result);
    }
  }
  return result;
}

SeparateSolids replaceUnions(const std::vector<Solid>& solids, const UnionSettings& settings,
                             const std::string& reason, const std::string& name) {
  SeparateSolids result;
  for (const std::vector<Solid>& group : contactGroups(solids)) {
    if (group.size() == 1) {
      result.solids.push_back(group.front());
    } else {
      fallBack(group, settings, reason, name, result);
    }
  }
  return result;
}

}  // namespace ambient
