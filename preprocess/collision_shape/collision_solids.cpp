#include "preprocess/collision_shape/collision_solids.h"

#include <algorithm>

#include "bullet_ambient/spatial/inertia.h"
#include "preprocess/added_mass_tables/known_added_mass.h"
#include "preprocess/mesh/graded_grid.h"
#include "preprocess/mesh/mesh_checks.h"
#include "preprocess/mesh/weld_vertices.h"

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {
namespace {

Solid placed(Solid solid, const ShapePart& part) {
  for (TriangleMesh* mesh : {&solid.mesh, &solid.flow, &solid.coarse_flow, &solid.cavities}) {
    mesh->vertices = (part.rotation * mesh->vertices).colwise() + part.translation;
  }
  if (solid.added_mass) {
    solid.added_mass = shiftOrigin(rotateAxes(*solid.added_mass, part.rotation), -part.translation);
  }
  solid.part = part.part;
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

Solid makeMeshSolid(const ShapePart& part) {
  CheckedMesh checked = checkMesh(joinTriangles(part.points), part.name);
  Solid solid;
  solid.mesh = std::move(checked.mesh);
  solid.cavities = std::move(checked.cavities);
  solid.warnings = std::move(checked.warnings);
  return solid;
}

Solid makeBallHull(const ShapePart& part, const SolidResolution& resolution) {
  std::vector<HullBall> balls;
  for (std::size_t i = 0; i < part.points.size(); ++i) {
    balls.push_back(
        {part.points[i], {part.sizes[3 * i], part.sizes[3 * i + 1], part.sizes[3 * i + 2]}});
  }
  return makeBallHullSolid(balls, resolution, part.name);
}

Solid makeMeshes(const ShapePart& part, const SolidResolution& resolution) {
  const std::vector<double>& sizes = part.sizes;
  switch (part.kind) {
    case PartKind::kBall:
      return makeBallSolid(sizes[0], resolution, part.name);
    case PartKind::kBox:
      return makeBoxSolid({sizes[0], sizes[1], sizes[2]}, resolution, part.name);
    case PartKind::kCylinder:
      return makeCylinderSolid(sizes[0], sizes[1], resolution, part.name);
    case PartKind::kCapsule:
      return makeCapsuleSolid(sizes[0], sizes[1], resolution, part.name);
    case PartKind::kCone:
      return makeConeSolid(sizes[0], sizes[1], part.margin, resolution, part.name);
    case PartKind::kBallHull:
      return makeBallHull(part, resolution);
    case PartKind::kHull:
      return makeHullSolid(part.points, part.margin, resolution, part.name);
    case PartKind::kMesh:
      return makeMeshSolid(part);
  }
  return {};
}

Solid makeSolid(const ShapePart& part, SolidResolution resolution) {
  const auto tabulated = resolution.tables ? tabulatedAddedMass(part) : std::nullopt;
  if (tabulated) resolution.flow_faces = resolution.faces;  // no flow is solved
  Solid solid = makeMeshes(part, resolution);
  if (tabulated) solid.added_mass = tabulated;
  return solid;
}

}  // namespace

std::optional<Matrix6> tabulatedAddedMass(const ShapePart& part) {
  const std::vector<double>& sizes = part.sizes;
  switch (part.kind) {
    case PartKind::kBox:
      return boxAddedMass({sizes[0], sizes[1], sizes[2]});
    case PartKind::kCylinder:
      return cylinderAddedMass(sizes[0], sizes[1]);
    case PartKind::kCapsule:
      if (sizes[1] == 0) return std::nullopt;  // a ball, which has a closed form
      return capsuleAddedMass(sizes[0], sizes[1]);
    case PartKind::kCone:
      return coneAddedMass(sizes[0], sizes[1], std::max(part.margin, 0.0));
    default:
      return std::nullopt;
  }
}

std::vector<Solid> makeSolids(const std::vector<ShapePart>& parts,
                              const SolidResolution& resolution) {
  const int count = std::max(1, static_cast<int>(parts.size()));
  constexpr int kFewestFaces = 20;  // that all kinds can be made of
  SolidResolution each = resolution;
  each.least_faces = std::min(resolution.least_faces,
                              std::max(kFewestFaces, kMostOfMany * resolution.faces / count));
  each.faces = std::max(each.least_faces, resolution.faces / count);
  each.flow_faces = std::max(each.faces, resolution.flow_faces / count);
  std::vector<Solid> solids;
  for (const ShapePart& part : parts) solids.push_back(placed(makeSolid(part, each), part));
  return solids;
}

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
