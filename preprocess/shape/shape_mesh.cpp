#include "preprocess/shape/shape_mesh.h"

#include <cmath>

#include "bullet_ambient/spatial/ambient_assert.h"
#include "bullet_ambient/spatial/elementary.h"
#include "bullet_ambient/spatial/pi.h"
#include "preprocess/mesh/convex_hull.h"
#include "preprocess/mesh/input_error.h"
#include "preprocess/mesh/mass_properties.h"
#include "preprocess/mesh/mesh_checks.h"
#include "preprocess/mesh/primitives.h"
#include "preprocess/mesh/surface_wrap.h"
#include "preprocess/mesh/usual_size.h"
#include "preprocess/shape/shape_limits.h"

namespace ambient {
namespace {

// For cylinders and cones: lengths along the axis are exact as they are.
TriangleMesh withVolumeAcross(TriangleMesh mesh, double volume) {
  const double stretch = std::sqrt(volume / computeMassProperties(mesh).volume);
  mesh.vertices.topRows<2>() *= stretch;
  return mesh;
}

TriangleMesh withVolume(TriangleMesh mesh, double volume) {
  mesh.vertices *= portable::cbrt(volume / computeMassProperties(mesh).volume);
  return mesh;
}

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

CheckedMesh makeBody(const TriangleMesh& mesh, const MeshShape& shape) {
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

CheckedMesh checkAs(const MeshShape& shape, const TriangleMesh& mesh) {
  return makeBody(mesh, shape);
}

CheckedMesh checkAs(const MeshSheetShape& shape, const TriangleMesh& mesh) {
  return checkMesh(mesh, shape.file.string(), {true});
}

/// Of a MeshShape or a MeshSheetShape.
template <class Shape>
CheckedMesh checkImported(const Shape& shape, const ImportedMesh& imported) {
  CheckedMesh checked = checkAs(shape, imported.mesh);
  checked.warnings.insert(checked.warnings.begin(), imported.warnings.begin(),
                          imported.warnings.end());
  return checked;
}

/// Makes the mesh of every kind of shape with `faces` triangles.
struct MeshMaker {
  int faces;

  CheckedMesh operator()(const SphereShape& s) const {
    return (*this)(EllipsoidShape{Eigen::Vector3d::Constant(s.radius)});
  }
  CheckedMesh operator()(const EllipsoidShape& s) const {
    const double volume = 4 * kPi / 3 * s.semi_axes.prod();
    return {withVolume(makeEllipsoidMesh(s.semi_axes, faces), volume), {}};
  }
  CheckedMesh operator()(const BoxShape& s) const { return {makeBoxMesh(s.half_sizes, faces), {}}; }
  CheckedMesh operator()(const CylinderShape& s) const {
    const double volume = kPi * s.radius * s.radius * s.height;
    return {withVolumeAcross(makeCylinderMesh(s.radius, s.height, faces), volume), {}};
  }
  CheckedMesh operator()(const CapsuleShape& s) const {
    const double volume = kPi * s.radius * s.radius * (s.height + 4 * s.radius / 3);
    return {withVolume(makeCapsuleMesh(s.radius, s.height, faces), volume), {}};
  }
  CheckedMesh operator()(const ConeShape& s) const {
    const double volume = kPi * s.radius * s.radius * s.height / 3;
    return {withVolumeAcross(makeConeMesh(s.radius, s.height, faces), volume), {}};
  }
  CheckedMesh operator()(const RectangularSheetShape& s) const {
    return {makeRectangularSheetMesh(s.size.x(), s.size.y(), faces), {}};
  }
  CheckedMesh operator()(const EllipticSheetShape& s) const {
    TriangleMesh mesh = makeEllipticSheetMesh(s.semi_axes.x(), s.semi_axes.y(), faces);
    mesh.vertices *= std::sqrt(kPi * s.semi_axes.prod() / computeSheetMassProperties(mesh).area);
    return {mesh, {}};
  }
  CheckedMesh operator()(const MeshShape& s) const {
    return checkImported(s, importMesh(s.file, s.scale));
  }
  CheckedMesh operator()(const MeshSheetShape& s) const {
    return checkImported(s, importMesh(s.file, s.scale));
  }
  CheckedMesh operator()(const FluidBodyShape& s) const {
    throw std::logic_error(s.file.string() + ": a fluid body is read, not meshed");
  }
};

struct FileFinder {
  std::filesystem::path operator()(const MeshShape& s) const { return s.file; }
  std::filesystem::path operator()(const MeshSheetShape& s) const { return s.file; }
  std::filesystem::path operator()(const FluidBodyShape& s) const { return s.file; }
  template <class Other>
  std::filesystem::path operator()(const Other&) const {
    return {};
  }
};

CheckedMesh makeUnscaledMesh(const ShapeDescription& shape) {
  try {
    return std::visit(MeshMaker{shape.faces}, shape.geometry);
  } catch (const std::runtime_error& error) {
    // Messages about a file begin with it already.
    const bool names_file = !fileOf(shape).empty() || shape.source.empty();
    if (names_file) throw;
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
  const std::string warning = unlikelySizeWarning(checked.mesh, file.string());
  if (!warning.empty()) checked.warnings.push_back(warning);
  return checked;
}

}  // namespace

bool isSheet(const ShapeDescription& shape) {
  return std::holds_alternative<RectangularSheetShape>(shape.geometry) ||
         std::holds_alternative<EllipticSheetShape>(shape.geometry) ||
         std::holds_alternative<MeshSheetShape>(shape.geometry);
}

std::filesystem::path fileOf(const ShapeDescription& shape) {
  return std::visit(FileFinder{}, shape.geometry);
}

CheckedMesh makeShapeMesh(const ShapeDescription& shape, double scale) {
  requireUsualExtents(shape, scale);
  return scaled(makeUnscaledMesh(shape), shape, scale);
}

CheckedMesh makeShapeMesh(const ShapeDescription& shape, const ImportedMesh& imported,
                          double scale) {
  if (const auto* mesh = std::get_if<MeshShape>(&shape.geometry))
    return scaled(checkImported(*mesh, imported), shape, scale);
  return scaled(checkImported(std::get<MeshSheetShape>(shape.geometry), imported), shape, scale);
}

}  // namespace ambient
