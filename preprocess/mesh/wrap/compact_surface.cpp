#include "preprocess/mesh/wrap/compact_surface.h"

#include <cmath>
#include <utility>

#include "bullet_ambient/base/elementary.h"
#include "preprocess/mesh/mass_properties.h"
#include "preprocess/mesh/wrap/mesh_coarsening.h"
#include "preprocess/mesh/wrap/surface_wrap.h"

namespace ambient {
namespace {

bool isWithin(double share, double now, double then) { return std::abs(now / then - 1) <= share; }

/// Stretched and moved to the volume and the centre of a body.
TriangleMesh fitted(TriangleMesh mesh, const MeshProperties& own, const MeshProperties& body) {
  const double stretch = portable::cbrt(body.volume / own.volume);
  mesh.vertices =
      (stretch * (mesh.vertices.colwise() - own.uniform.centre)).colwise() + body.uniform.centre;
  return mesh;
}

}  // namespace

std::optional<TriangleMesh> compactSurface(const TriangleMesh& mesh, int triangles) {
  constexpr double kSquares = 8000, kMostNodes = 5e6;
  constexpr double kVolumeChange = 0.0025, kAreaChange = 0.005;
  const MeshProperties body = computeMassProperties(mesh);
  const double step = std::sqrt(body.area / kSquares);
  if (!(gridNodesAround(mesh, step) <= kMostNodes)) return std::nullopt;
  TriangleMesh compact = wrapped(mesh, step, {triangles, triangles, 0});
  if (compact.triangleCount() == 0) return std::nullopt;
  const MeshProperties found = computeMassProperties(compact);
  if (!isWithin(kVolumeChange, found.volume, body.volume)) return std::nullopt;
  if (!isWithin(kAreaChange, found.area, body.area)) return std::nullopt;
  return fitted(std::move(compact), found, body);
}

std::optional<TriangleMesh> inFewerTriangles(const TriangleMesh& mesh, int triangles) {
  constexpr double kVolumeChange = 0.02, kAreaChange = 0.02, kTooMany = 1.1;
  TriangleMesh fewer = coarsened(mesh, {triangles, triangles, 0});
  if (static_cast<double>(fewer.triangleCount()) > kTooMany * triangles) return std::nullopt;
  const MeshProperties found = computeMassProperties(fewer), body = computeMassProperties(mesh);
  if (!isWithin(kVolumeChange, found.volume, body.volume)) return std::nullopt;
  if (!isWithin(kAreaChange, found.area, body.area)) return std::nullopt;
  return fitted(std::move(fewer), found, body);
}

}  // namespace ambient
