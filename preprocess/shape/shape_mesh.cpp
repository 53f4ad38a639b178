#include "preprocess/shape/shape_mesh.h"

#include <cmath>

#include "bullet_ambient/base/ambient_assert.h"
#include "preprocess/mesh/check/mesh_checks.h"
#include "preprocess/mesh/input_error.h"
#include "preprocess/mesh/shapes/convex_hull.h"
#include "preprocess/mesh/usual_size.h"
#include "preprocess/mesh/wrap/surface_wrap.h"
#include "preprocess/shape/shape_facts.h"

namespace ambient {
namespace {

/// checkMesh() that mentions a remedy.
CheckedMesh checkBody(const TriangleMesh& mesh, const std::string& name) {
  try {
    return checkMesh(mesh, name);
  } catch (const std::runtime_error& error) {
    if (!canBeWrapped(mesh)) throw;
    throw std::runtime_error(std::string(error.what()) +
                             " (build --wrap makes a closed surface around it)");
  }
}

CheckedMesh makeBody(const TriangleMesh& mesh, const MeshFile& shape) {
  const std::string name = shape.file.string();
  switch (shape.stand_in) {
    case MeshStandIn::kHull:
      return checkMesh(makeConvexHull(mesh.vertices, name), name);
    case MeshStandIn::kWrap:
      return wrapSurface(mesh, shape.wrap_size, name);
    case MeshStandIn::kNone:
      break;
  }
  return checkBody(mesh, name);
}

/// Checks the imported mesh of a MeshFile or a MeshSheet.
CheckedMesh checkImported(const Shape& shape, const ImportedMesh& imported) {
  CheckedMesh checked;
  if (const auto* file = std::get_if<MeshFile>(&shape)) {
    TriangleMesh mesh = imported.mesh;
    mesh.vertices = file->stretch.asDiagonal() * mesh.vertices;
    checked = makeBody(mesh, *file);
  } else {
    checked = checkMesh(imported.mesh, std::get<MeshSheet>(shape).file.string(), {true});
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

CheckedMesh makeUnscaledMesh(const ShapeDescription& shape) {
  if (const auto* mesh = std::get_if<MeshFile>(&shape.geometry))
    return checkImported(shape.geometry, importMesh(mesh->file, mesh->scale));
  if (const auto* sheet = std::get_if<MeshSheet>(&shape.geometry))
    return checkImported(shape.geometry, importMesh(sheet->file, sheet->scale));
  const ShapeFacts facts = factsOf(shape.geometry);
  if (!facts.mesh) throw std::logic_error(shape.source + ": no mesh is made of this kind of shape");
  try {
    return {facts.mesh(shape.faces), {}};
  } catch (const std::runtime_error& error) {
    if (shape.source.empty()) throw;
    raiseInputError(shape.source, error.what());
  }
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
