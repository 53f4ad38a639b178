#include "preprocess/shape/shape_mesh.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bullet_ambient/base/ambient_assert.h"
#include "preprocess/mesh/check/mesh_checks.h"
#include "preprocess/mesh/input_error.h"
#include "preprocess/mesh/join_meshes.h"
#include "preprocess/mesh/shapes/convex_hull.h"
#include "preprocess/mesh/usual_size.h"
#include "preprocess/mesh/wrap/surface_wrap.h"
#include "preprocess/shape/shape_facts.h"

namespace ambient {
namespace {

CheckedMesh makeBody(const TriangleMesh& mesh, const MeshFile& shape) {
  const std::string name = shape.file.string();
  switch (shape.stand_in) {
    case MeshStandIn::kHull:
      return requireSound(checkMesh(makeConvexHull(mesh.vertices, name), name), name);
    case MeshStandIn::kWrap:
      return wrapSurface(mesh, shape.wrap_size, name);
    case MeshStandIn::kNone:
      break;
  }
  return makeBodyMesh(mesh, name, shape.strict);
}

/// Checks the imported mesh of a MeshFile or a MeshSheet.
CheckedMesh checkImported(const Shape& shape, const ImportedMesh& imported) {
  CheckedMesh checked;
  if (const auto* file = std::get_if<MeshFile>(&shape)) {
    TriangleMesh mesh = imported.mesh;
    mesh.vertices = file->stretch.asDiagonal() * mesh.vertices;
    checked = makeBody(mesh, *file);
  } else {
    const std::string name = std::get<MeshSheet>(shape).file.string();
    checked = requireSound(checkMesh(imported.mesh, name, {true}), name);
  }
  checked.warnings.insert(checked.warnings.begin(), imported.warnings.begin(),
                          imported.warnings.end());
  return checked;
}

struct FileFinder {
  std::filesystem::path operator()(const MeshFile& s) const { return s.file; }
  std::filesystem::path operator()(const MeshSheet& s) const { return s.file; }
  std::filesystem::path operator()(const FluidBodyFile& s) const { return s.file; }
  template <class Other>
  std::filesystem::path operator()(const Other&) const {
    return {};
  }
};

TriangleMesh makeFactMesh(const Shape& shape, int faces, const std::string& source) {
  const ShapeFacts facts = factsOf(shape);
  if (!facts.mesh) throw std::logic_error(source + ": no mesh is made of this kind of shape");
  try {
    return facts.mesh(faces);
  } catch (const std::runtime_error& error) {
    if (source.empty()) throw;
    raiseInputError(source, error.what());
  }
}

/// One surface around all parts, which share the faces.
CheckedMesh makeCompoundMesh(const Compound& compound, int faces, const std::string& source) {
  constexpr int kFewest = 100;  // of a part
  const int each = std::max(kFewest, faces / static_cast<int>(compound.parts.size()));
  std::vector<TriangleMesh> meshes;
  for (const PlacedShape& part : compound.parts) {
    requireUsualExtents(part.shape, 1, part.name);
    const int least = factsOf(part.shape).least_faces();
    TriangleMesh mesh = makeFactMesh(part.shape, std::max(each, least), part.name);
    mesh.vertices = part.pose * mesh.vertices;
    meshes.push_back(std::move(mesh));
  }
  const TriangleMesh all = joinMeshes(meshes);
  CheckedMesh checked = checkMesh(all, source);
  if (!checked.defects.empty()) return makeBodyMesh(all, source, false);
  checked.warnings.clear();  // that parts were united, as they are meant to be
  return checked;
}

CheckedMesh makeUnscaledMesh(const ShapeDescription& shape) {
  if (const auto* compound = std::get_if<Compound>(&shape.geometry))
    return makeCompoundMesh(*compound, shape.faces, shape.source);
  if (const auto* mesh = std::get_if<MeshFile>(&shape.geometry))
    return checkImported(shape.geometry, importMesh(mesh->file, mesh->scale));
  if (const auto* sheet = std::get_if<MeshSheet>(&shape.geometry))
    return checkImported(shape.geometry, importMesh(sheet->file, sheet->scale));
  return {makeFactMesh(shape.geometry, shape.faces, shape.source), {}};
}

CheckedMesh scaled(CheckedMesh checked, const ShapeDescription& shape, double scale) {
  AMBIENT_ASSERT(scale > 0 && std::isfinite(scale));
  checked.mesh.vertices *= scale;
  checked.cavities.vertices *= scale;
  // Shapes are described in metres; what the unit of a file is, is not known.
  const std::filesystem::path file = fileOf(shape);
  if (file.empty()) return checked;
  const std::string warning = unlikelySizeWarning(checked.mesh, scale != 1, file.string());
  if (!warning.empty()) checked.warnings.push_back(warning);
  return checked;
}

}  // namespace

bool isSheet(const ShapeDescription& shape) {
  return std::holds_alternative<RectangleSheet>(shape.geometry) ||
         std::holds_alternative<EllipseSheet>(shape.geometry) ||
         std::holds_alternative<MeshSheet>(shape.geometry);
}

std::filesystem::path fileOf(const ShapeDescription& shape) {
  return std::visit(FileFinder{}, shape.geometry);
}

CheckedMesh makeShapeMesh(const ShapeDescription& shape, double scale) {
  requireUsualExtents(shape.geometry, scale, shape.source);
  return scaled(makeUnscaledMesh(shape), shape, scale);
}

CheckedMesh makeShapeMesh(const ShapeDescription& shape, const ImportedMesh& imported,
                          double scale) {
  return scaled(checkImported(shape.geometry, imported), shape, scale);
}

}  // namespace ambient
