#include "preprocess/shape/shape_mesh.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/pi.h"
#include "preprocess/added_mass_tables/known_added_mass.h"
#include "preprocess/mesh/check/mesh_checks.h"
#include "preprocess/mesh/input_error.h"
#include "preprocess/mesh/mass_properties.h"
#include "preprocess/mesh/shapes/convex_hull.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "preprocess/mesh/triangle_mesh.h"
#include "preprocess/mesh/wrap/surface_wrap.h"
#include "preprocess/potential_flow/results/ellipsoid_added_mass.h"
#include "preprocess/resistance/known_viscous_flow.h"

namespace ambient {

namespace {

/// For cylinders and cones: lengths along the axis are exact as they are.
TriangleMesh withVolumeAcross(TriangleMesh mesh, double volume) {
  mesh.vertices.topRows<2>() *= std::sqrt(volume / computeMassProperties(mesh).volume);
  return mesh;
}

std::optional<KnownAddedMass> closedForm(const Eigen::Vector3d& semi_axes) {
  // Spin about an axis of revolution moves nothing, but for rounding of either sign.
  const Vector6 diagonal = ellipsoidAddedMass(semi_axes).cwiseMax(0);
  return KnownAddedMass{diagonal.asDiagonal(), false, "closed form"};
}

std::optional<KnownAddedMass> tabulated(const std::optional<Matrix6>& added_mass) {
  if (!added_mass) return std::nullopt;
  return KnownAddedMass{*added_mass, true, addedMassTablesName()};
}

Eigen::Vector3d roundExtents(double radius, double half_height) {
  return {radius, radius, half_height};
}

/// Facts of each kind of shape: a new kind adds an overload.
struct FactFinder {
  ShapeFacts operator()(const Ellipsoid& s) const {
    ShapeFacts facts;
    facts.half_extents = s.semi_axes;
    facts.mesh = [s](int faces) {
      const double volume = 4 * kPi / 3 * s.semi_axes.prod();
      return withVolume(makeEllipsoidMesh(s.semi_axes, faces), volume);
    };
    facts.added_mass = [s](double scale) { return closedForm(scale * s.semi_axes); };
    facts.viscous_flow = [s](double scale, const Matrix6& added_mass) {
      return ellipsoidViscousFlow(scale * s.semi_axes, added_mass);
    };
    facts.is_smooth = true;
    return facts;
  }

  ShapeFacts operator()(const Sphere& s) const {
    ShapeFacts facts = (*this)(Ellipsoid{Eigen::Vector3d::Constant(s.radius)});
    facts.sphere_radius = s.radius;
    return facts;
  }

  ShapeFacts operator()(const Box& s) const {
    ShapeFacts facts;
    facts.half_extents = s.half_sizes;
    facts.mesh = [s](int faces) { return makeBoxMesh(s.half_sizes, faces); };
    facts.added_mass = [s](double scale) { return tabulated(boxAddedMass(scale * s.half_sizes)); };
    facts.viscous_flow = [s](double scale, const Matrix6&) {
      return boxViscousFlow(scale * s.half_sizes);
    };
    return facts;
  }

  ShapeFacts operator()(const Cylinder& s) const {
    ShapeFacts facts;
    facts.half_extents = roundExtents(s.radius, s.height / 2);
    facts.mesh = [s](int faces) {
      const double volume = kPi * s.radius * s.radius * s.height;
      return withVolumeAcross(makeCylinderMesh(s.radius, s.height, faces), volume);
    };
    facts.least_faces = [s] { return leastCylinderFaces(s.radius, s.height); };
    facts.added_mass = [s](double scale) {
      return tabulated(cylinderAddedMass(scale * s.radius, scale * s.height));
    };
    facts.viscous_flow = [s](double scale, const Matrix6& added_mass) {
      return cylinderViscousFlow(scale * s.radius, scale * s.height, added_mass);
    };
    return facts;
  }

  ShapeFacts operator()(const Capsule& s) const {
    if (s.height == 0) return (*this)(Sphere{s.radius});
    ShapeFacts facts;
    facts.half_extents = roundExtents(s.radius, s.height / 2 + s.radius);
    facts.mesh = [s](int faces) {
      const double volume = kPi * s.radius * s.radius * (s.height + 4 * s.radius / 3);
      return withVolume(makeCapsuleMesh(s.radius, s.height, faces), volume);
    };
    facts.least_faces = [s] { return leastCapsuleFaces(s.radius, s.height); };
    facts.added_mass = [s](double scale) {
      return tabulated(capsuleAddedMass(scale * s.radius, scale * s.height));
    };
    facts.viscous_flow = [s](double scale, const Matrix6& added_mass) {
      return capsuleViscousFlow(scale * s.radius, scale * s.height, added_mass);
    };
    facts.is_smooth = true;
    return facts;
  }

  ShapeFacts operator()(const Cone& s) const {
    ShapeFacts facts;
    facts.half_extents = roundExtents(s.radius, s.height / 2);
    facts.mesh = [s](int faces) {
      const double volume = kPi * s.radius * s.radius * s.height / 3;
      return withVolumeAcross(makeConeMesh(s.radius, s.height, faces), volume);
    };
    facts.least_faces = [s] { return leastConeFaces(s.radius, s.height); };
    facts.added_mass = [s](double scale) {
      return tabulated(coneAddedMass(scale * s.radius, scale * s.height));
    };
    facts.viscous_flow = [s](double scale, const Matrix6&) {
      return coneViscousFlow(scale * s.radius, scale * s.height);
    };
    return facts;
  }

  ShapeFacts operator()(const RectangleSheet& s) const {
    ShapeFacts facts;
    facts.half_extents = s.size / 2;
    facts.mesh = [s](int faces) { return makeRectangularSheetMesh(s.size.x(), s.size.y(), faces); };
    return facts;
  }

  ShapeFacts operator()(const EllipseSheet& s) const {
    ShapeFacts facts;
    facts.half_extents = s.semi_axes;
    facts.mesh = [s](int faces) {
      TriangleMesh mesh = makeEllipticSheetMesh(s.semi_axes.x(), s.semi_axes.y(), faces);
      mesh.vertices *= std::sqrt(kPi * s.semi_axes.prod() / computeSheetMassProperties(mesh).area);
      return mesh;
    };
    return facts;
  }

  template <class Other>
  ShapeFacts operator()(const Other&) const {
    return {};
  }
};

std::string listOf(const Eigen::VectorXd& sizes) {
  std::ostringstream text;
  text.precision(9);
  for (Eigen::Index k = 0; k < sizes.size(); ++k) text << (k == 0 ? "" : " x ") << sizes[k];
  return text.str();
}

}  // namespace

ShapeFacts factsOf(const Shape& shape) { return std::visit(FactFinder{}, shape); }

void requireUsualExtents(const Shape& shape, double scale, const std::string& source) {
  constexpr double kMostSlender = 1e6;
  const Eigen::VectorXd sizes = scale * factsOf(shape).half_extents;
  if (sizes.size() == 0) return;
  const double least = sizes.minCoeff(), most = sizes.maxCoeff();
  if (!(most <= kMostSlender * least))
    raiseInputError(source, "its half extents are ", listOf(sizes),
                    " m; the longest must be at most ", kMostSlender, " times the shortest");
  if (!(least >= kSmallestSize && most <= kLargestSize))
    raiseInputError(source, "its half extents are ", listOf(sizes), " m; each must be ",
                    kSmallestSize, " m to ", kLargestSize, " m");
}

namespace {

/// Checks the imported mesh of a file.
CheckedMesh checkImported(const MeshFile& shape, const ImportedMesh& imported) {
  const std::string name = shape.file.string();
  TriangleMesh mesh = imported.mesh;
  mesh.vertices = shape.stretch.asDiagonal() * mesh.vertices;
  CheckedMesh checked;
  if (shape.sheet) {
    checked = requireSound(checkMesh(mesh, name, true), name);
  } else if (shape.stand_in == MeshStandIn::kHull) {
    checked = requireSound(checkMesh(makeConvexHull(mesh.vertices, name), name), name);
  } else if (shape.stand_in == MeshStandIn::kWrap) {
    checked = wrapSurface(mesh, shape.wrap_size, name);
  } else {
    checked = makeBodyMesh(mesh, name, shape.strict);
  }
  checked.warnings.insert(checked.warnings.begin(), imported.warnings.begin(),
                          imported.warnings.end());
  return checked;
}

TriangleMesh makeFactMesh(const Shape& shape, int faces, const std::string& source) {
  const ShapeFacts facts = factsOf(shape);
  if (!facts.mesh) throw std::logic_error(source + ": no mesh is made of this kind of shape");
  if (source.empty()) return facts.mesh(faces);
  return withSource(source, [&] { return facts.mesh(faces); });
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
    return checkImported(*mesh, importMesh(mesh->file, mesh->scale));
  return {makeFactMesh(shape.geometry, shape.faces, shape.source), {}};
}

CheckedMesh scaled(CheckedMesh checked, const ShapeDescription& shape, double scale) {
  AMBIENT_ASSERT(scale > 0 && std::isfinite(scale));
  checked.mesh.vertices *= scale;
  checked.cavities.vertices *= scale;
  // Shapes are described in metres; what the unit of a file is, is not known.
  const std::filesystem::path file = fileOf(shape);
  if (file.empty()) return checked;
  const auto* mesh = std::get_if<MeshFile>(&shape.geometry);
  const bool is_scaled =
      scale != 1 || (mesh && (mesh->scale != 1 || mesh->stretch != Eigen::Vector3d(1, 1, 1)));
  const std::string warning = unlikelySizeWarning(checked.mesh, is_scaled, file.string());
  if (!warning.empty()) checked.warnings.push_back(warning);
  return checked;
}

}  // namespace

bool isSheet(const ShapeDescription& shape) {
  const auto* mesh = std::get_if<MeshFile>(&shape.geometry);
  return std::holds_alternative<RectangleSheet>(shape.geometry) ||
         std::holds_alternative<EllipseSheet>(shape.geometry) || (mesh && mesh->sheet);
}

std::filesystem::path fileOf(const ShapeDescription& shape) {
  if (const auto* mesh = std::get_if<MeshFile>(&shape.geometry)) return mesh->file;
  const auto* body = std::get_if<FluidBodyFile>(&shape.geometry);
  return body ? body->file : std::filesystem::path();
}

CheckedMesh makeShapeMesh(const ShapeDescription& shape, double scale) {
  requireUsualExtents(shape.geometry, scale, shape.source);
  return scaled(makeUnscaledMesh(shape), shape, scale);
}

CheckedMesh makeShapeMesh(const ShapeDescription& shape, const ImportedMesh& imported,
                          double scale) {
  return scaled(checkImported(std::get<MeshFile>(shape.geometry), imported), shape, scale);
}

}  // namespace ambient
