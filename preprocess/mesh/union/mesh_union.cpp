#include "preprocess/mesh/union/mesh_union.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <random>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <vector>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/spatial/rotation.h"
#include "preprocess/mesh/defects/surface_crossing.h"
#include "preprocess/mesh/defects/topology_defects.h"
#include "preprocess/mesh/geometry.h"
#include "preprocess/mesh/mass_properties.h"
#include "preprocess/mesh/mend/mesh_mending.h"
#include "preprocess/mesh/triangle_mesh.h"
#include "preprocess/mesh/union/bsp_tree.h"

namespace ambient {
namespace {

using Eigen::Index;
using Eigen::Vector3d;

/// Edges of a through b, or corners of a closer to b than the gap.
bool reaches(const TriangleMesh& a, const TriangleMesh& b, double gap) {
  const Eigen::AlignedBox3d bounds_of_b = b.bounds();
  for (Index s = 0; s < a.triangleCount(); ++s) {
    const Eigen::AlignedBox3d bounds = boundsOf(a, s);
    if (!areNear(bounds, bounds_of_b, gap)) continue;
    for (Index t = 0; t < b.triangleCount(); ++t) {
      if (!areNear(bounds, boundsOf(b, t), gap)) continue;
      for (int k = 0; k < 3; ++k) {
        if (isCloser(a.corner(s, k), b, t, gap)) return true;
        if (crossesTriangle(a.corner(s, k), a.corner(s, (k + 1) % 3), b, t)) return true;
      }
    }
  }
  return false;
}

}  // namespace

bool areInContact(const TriangleMesh& a, const TriangleMesh& b) {
  const double gap = kLeastGap * std::min(a.extents().maxCoeff(), b.extents().maxCoeff());
  if (!areNear(a.bounds(), b.bounds(), gap)) return false;
  return reaches(a, b, gap) || reaches(b, a, gap) || solidAngle(b, a.vertices.col(0)) > 2 * kPi ||
         solidAngle(a, b.vertices.col(0)) > 2 * kPi;
}

namespace {

using Meshes = std::vector<TriangleMesh>;

/// The side of a body at an edge: its angle around the edge from low to high, and whether the body
/// lies at larger angles (a half edge from high to low) or at smaller ones.
struct WedgeSide {
  double angle = 0;
  HalfEdge edge;

  bool operator<(const WedgeSide& other) const {
    if (angle != other.angle) return angle < other.angle;
    return edge.forward && !other.edge.forward;  // one wedge ends before the next one begins
  }
};

std::vector<WedgeSide> sidesAround(const TriangleMesh& mesh, const MeshEdges& edges,
                                   const EdgeGroup& group) {
  const HalfEdge& first = edges.half_edges[group.first];
  const Vector3d low = mesh.vertices.col(first.low);
  const Vector3d along = (mesh.vertices.col(first.high) - low).stableNormalized();
  const Vector3d zero = along.unitOrthogonal(), quarter = along.cross(zero);
  // Triangles on each other differ by the rounding of their corners.
  constexpr double kSteps = 1e6;
  std::vector<WedgeSide> sides;
  for (std::size_t i = group.first; i < group.last; ++i) {
    const HalfEdge& edge = edges.half_edges[i];
    const Vector3d apex = mesh.corner(edge.triangle, (edge.side + 2) % 3) - low;
    const double angle = portable::atan2(apex.dot(quarter), apex.dot(zero));
    sides.push_back({std::round(angle * kSteps) / kSteps, edge});
  }
  std::sort(sides.begin(), sides.end());
  return sides;
}

/// Each side at which a wedge begins with the next one at which it ends, once around; none if they
/// are not as many.
std::vector<EdgePair> wedgesOf(const std::vector<WedgeSide>& sides) {
  std::vector<EdgePair> wedges;
  std::vector<HalfEdge> begun;
  std::vector<bool> is_used(sides.size(), false);
  for (std::size_t i = 0; i < 2 * sides.size(); ++i) {
    const std::size_t k = i % sides.size();
    if (is_used[k]) continue;
    if (!sides[k].edge.forward) {
      if (i < sides.size()) begun.push_back(sides[k].edge);
    } else if (!begun.empty()) {
      wedges.emplace_back(begun.back(), sides[k].edge);
      begun.pop_back();
      is_used[k] = true;
    }
  }
  if (2 * wedges.size() != sides.size()) wedges.clear();
  return wedges;
}

/// Every half edge with another one; none if that is not possible.
std::optional<std::vector<EdgePair>> pairEdges(const TriangleMesh& mesh) {
  const MeshEdges edges = computeMeshEdges(mesh);
  std::vector<EdgePair> pairs;
  for (const EdgeGroup& group : edges.edges) {
    if (group.size() == 2) {
      pairs.emplace_back(edges.half_edges[group.first], edges.half_edges[group.first + 1]);
      continue;
    }
    const std::vector<EdgePair> wedges = wedgesOf(sidesAround(mesh, edges, group));
    if (wedges.empty()) return std::nullopt;
    pairs.insert(pairs.end(), wedges.begin(), wedges.end());
  }
  return pairs;
}

/// Makes one mesh of all triangles t with the same `partOf(t)`. Corners of one set become one
/// vertex.
template <class PartOf>
std::vector<TriangleMesh> meshesOf(const TriangleMesh& mesh, const PartOf& partOf,
                                   DisjointSets& corners) {
  struct Part {
    std::vector<Vector3d> vertices;
    std::vector<Eigen::Vector3i> triangles;
    std::map<int, int> number;  // of a vertex, by the first corner of its set
  };
  std::vector<Part> made;
  std::map<int, std::size_t> part_of;
  for (int t = 0; t < static_cast<int>(mesh.triangleCount()); ++t) {
    const auto entry = part_of.emplace(partOf(t), made.size()).first;
    if (entry->second == made.size()) made.emplace_back();
    Part& part = made[entry->second];
    Eigen::Vector3i triangle;
    for (int k = 0; k < 3; ++k) {
      const auto [vertex, is_new] =
          part.number.emplace(corners.find(3 * t + k), static_cast<int>(part.vertices.size()));
      if (is_new) part.vertices.push_back(mesh.corner(t, k));
      triangle[k] = vertex->second;
    }
    part.triangles.push_back(triangle);
  }
  std::vector<TriangleMesh> meshes;
  for (const Part& part : made) meshes.push_back(makeTriangleMesh(part.vertices, part.triangles));
  return meshes;
}

/// Returns the parts of a mesh that are connected by edges of two triangles, each with vertices of
/// its own; equal vertices are joined. Cost O(T log T).
std::vector<TriangleMesh> componentsOf(const TriangleMesh& mesh) {
  DisjointSets corners(3 * static_cast<std::size_t>(mesh.triangleCount()));
  const MeshComponents parts = computeMeshComponents(mesh, computeMeshEdges(mesh));
  std::vector<TriangleMesh> meshes = meshesOf(
      mesh, [&](int t) { return parts.component_of[t]; }, corners);
  for (TriangleMesh& part : meshes) part = weldVertices(part, 0);
  return meshes;
}

/// Divides a mesh into closed surfaces, where some of them share edges, corners or whole triangles,
/// as boxes side by side do. At an edge of more than two triangles, those that bound the same wedge
/// of the body belong together. Each surface is manifold, with vertices of its own. Empty if an
/// edge cannot be divided so, for example where the mesh is open. Cost O(T log T).
std::vector<TriangleMesh> closedParts(const TriangleMesh& mesh) {
  const auto pairs = pairEdges(mesh);
  if (!pairs) return {};
  DisjointSets parts(static_cast<std::size_t>(mesh.triangleCount()));
  DisjointSets corners(3 * static_cast<std::size_t>(mesh.triangleCount()));
  for (const EdgePair& edge : *pairs) {
    parts.join(edge.first.triangle, edge.second.triangle);
    joinCorners(corners, mesh, edge);
  }
  return meshesOf(
      mesh, [&](int t) { return parts.find(t); }, corners);
}

/// Tolerances of a union, as fractions of the size of all its parts together.
struct Tolerances {
  double on_plane, welded;
};

constexpr double kOnPlane = 5e-6;  // what places and sizes of a form are rounded by, with room
constexpr Tolerances kOfForms{kOnPlane, 4 * kOnPlane};
// Rounding error of cuts: about 1e-16 over the angle of two planes. Between triangles of
// one flat side, given in single precision, it can be as small as 1e-8.
constexpr Tolerances kOfCuts{1e-9, 1e-8};

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

/// For each part, those that may take something off it.
std::vector<std::vector<std::size_t>> neighboursByBounds(const Meshes& parts, double reach) {
  std::vector<Eigen::AlignedBox3d> bounds;
  for (const TriangleMesh& part : parts) bounds.push_back(part.bounds());
  std::vector<std::vector<std::size_t>> neighbours(parts.size());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    for (std::size_t j = 0; j < parts.size(); ++j)
      if (i != j && bounds[i].exteriorDistance(bounds[j]) <= reach) neighbours[i].push_back(j);
  }
  return neighbours;
}

/// The surface of the union, closed if nothing went wrong.
TriangleMesh unionSurface(const Meshes& parts, double size, const Tolerances& tolerances) {
  const double welded = tolerances.welded * size;
  const auto neighbours = neighboursByBounds(parts, welded);
  std::map<std::size_t, BspTree> trees;
  for (const auto& of_part : neighbours) {
    for (const std::size_t j : of_part)
      if (trees.count(j) == 0) trees.emplace(j, BspTree(parts[j], tolerances.on_plane * size));
  }
  std::vector<FlatPolygon> surface;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    std::vector<FlatPolygon> left = polygonsOf(parts[i]);
    for (const std::size_t j : neighbours[i]) {
      std::vector<FlatPolygon> next;
      for (const FlatPolygon& polygon : left) {
        const std::vector<FlatPolygon> pieces = trees.at(j).clip(polygon, i < j);
        next.insert(next.end(), pieces.begin(), pieces.end());
      }
      left = std::move(next);
    }
    surface.insert(surface.end(), left.begin(), left.end());
  }
  return stitched(meshOf(surface, welded), welded);
}

TriangleMesh enlarged(TriangleMesh mesh, double share) {
  const Eigen::Vector3d centre = mesh.bounds().center();
  mesh.vertices += share * (mesh.vertices.colwise() - centre);
  return mesh;
}

/// Each enlarged by the share to twice the share, and turned by a fiftieth of it about some axis:
/// planes of two parts then cross at angles that cutting resolves, or lie apart.
Meshes inGeneralPosition(const Meshes& parts, double share, std::mt19937& generator) {
  constexpr double kTurn = 0.02;
  const auto random = [&] { return static_cast<double>(generator()) / std::mt19937::max(); };
  Meshes moved;
  for (const TriangleMesh& part : parts) {
    TriangleMesh mesh = enlarged(part, share * (1 + random()));
    const double x = random() - 0.5, y = random() - 0.5, z = random() - 0.5;
    const Matrix3 turn =
        rotationFromVector(kTurn * share * Vector3(x, y, z).normalized()).toRotationMatrix();
    const Eigen::Vector3d centre = part.bounds().center();
    mesh.vertices = (turn * (mesh.vertices.colwise() - centre)).colwise() + centre;
    moved.push_back(std::move(mesh));
  }
  return moved;
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
  if (volume >= (1 - kTolerance) * largest && volume <= (1 + kTolerance) * sumOfVolumes(parts))
    return;
  throw std::runtime_error("the surface of their union has a volume of its own");
}

/// Outward, whichever way round it was.
TriangleMesh orientedPart(const TriangleMesh& part, const std::string& name) {
  TriangleMesh oriented =
      requireSound(orientConsistently(part, computeMeshEdges(part), name), name).mesh;
  if (computeMassProperties(oriented).volume < 0) {
    for (Eigen::Index t = 0; t < oriented.triangleCount(); ++t) turnRound(oriented, t);
  }
  return oriented;
}

/// @throws std::runtime_error with the reason, as uniteMeshes().
CheckedMesh unitedAsTheyAre(const Meshes& parts, const Tolerances& tolerances,
                            const std::string& name) {
  const double size = joinMeshes(parts).extents().norm();
  CheckedMesh united =
      requireSound(checkSurface(unionSurface(parts, size, tolerances), name), name);
  requireVolume(united.mesh, parts);
  requireGaps(united.mesh);
  united.warnings.clear();  // of what came of cutting
  return united;
}

}  // namespace

CheckedMesh uniteMeshes(const Meshes& parts, const std::string& name, UnionTries tries) {
  std::string reason;
  const auto tryToUnite = [&](const Meshes& moved,
                              const Tolerances& tolerances) -> std::optional<CheckedMesh> {
    try {
      return unitedAsTheyAre(moved, tolerances, name);
    } catch (const std::runtime_error& error) {
      if (reason.empty()) reason = error.what();
      return std::nullopt;
    }
  };
  for (const double share : {0.0, 3e-4, 1.2e-3}) {
    Meshes enlarged_parts;
    for (const TriangleMesh& part : parts) enlarged_parts.push_back(enlarged(part, share));
    if (auto united = tryToUnite(enlarged_parts, kOfForms)) return *std::move(united);
    if (tries == UnionTries::kOne) throw std::runtime_error(reason);
  }
  std::mt19937 generator;  // the same numbers everywhere
  for (const double share : {3e-4, 6e-4, 6e-4, 6e-4}) {
    const Meshes moved = inGeneralPosition(parts, share, generator);
    if (auto united = tryToUnite(moved, kOfCuts)) return *std::move(united);
  }
  throw std::runtime_error(reason);
}

std::optional<CheckedMesh> uniteClosedParts(const TriangleMesh& mesh, const std::string& name) {
  constexpr Eigen::Index kMostTriangles = 20000;  // takes seconds
  if (mesh.triangleCount() > kMostTriangles) return std::nullopt;
  Meshes parts = closedParts(mesh);
  if (parts.size() < 2) return std::nullopt;
  try {
    for (TriangleMesh& part : parts) part = orientedPart(part, name);
    CheckedMesh united = uniteMeshes(parts, name);
    std::ostringstream warning;
    warning.precision(4);
    warning << name << ": " << parts.size() << " closed parts were united: volume "
            << computeMassProperties(united.mesh).volume << " m^3, in sum they have "
            << sumOfVolumes(parts) << " m^3";
    united.warnings.push_back(warning.str());
    return united;
  } catch (const std::runtime_error&) {
    return std::nullopt;
  }
}

}  // namespace ambient
