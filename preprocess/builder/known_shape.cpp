#include "preprocess/builder/known_shape.h"

#include "bullet_ambient/spatial/inertia.h"
#include "preprocess/added_mass_tables/known_added_mass.h"
#include "preprocess/mesh/mass_properties.h"
#include "preprocess/potential_flow/ellipsoid_added_mass.h"

namespace ambient {
namespace {

std::optional<KnownShape> closedForm(const Vector3& semi_axes) {
  // Spin about an axis of revolution moves nothing, but for rounding of either sign.
  const Vector6 diagonal = ellipsoidAddedMass(semi_axes).cwiseMax(0);
  return KnownShape{diagonal.asDiagonal(), false, "closed form"};
}

std::optional<KnownShape> tabulated(const std::optional<Matrix6>& added_mass) {
  if (!added_mass) return std::nullopt;
  return KnownShape{*added_mass, true, addedMassTablesName()};
}

/// Of every kind of shape, if there is one.
struct KnownShapeFinder {
  double scale;

  std::optional<KnownShape> operator()(const SphereShape& s) const {
    return closedForm(scale * Vector3::Constant(s.radius));
  }
  std::optional<KnownShape> operator()(const EllipsoidShape& s) const {
    return closedForm(scale * s.semi_axes);
  }
  std::optional<KnownShape> operator()(const BoxShape& s) const {
    return tabulated(boxAddedMass(scale * s.half_sizes));
  }
  std::optional<KnownShape> operator()(const CylinderShape& s) const {
    return tabulated(cylinderAddedMass(scale * s.radius, scale * s.height));
  }
  std::optional<KnownShape> operator()(const CapsuleShape& s) const {
    return tabulated(capsuleAddedMass(scale * s.radius, scale * s.height));
  }
  std::optional<KnownShape> operator()(const ConeShape& s) const {
    return tabulated(coneAddedMass(scale * s.radius, scale * s.height));
  }
  template <class Other>
  std::optional<KnownShape> operator()(const Other&) const {
    return std::nullopt;
  }
};

}  // namespace

std::optional<KnownShape> findKnownShape(const ShapeDescription& shape, double scale) {
  if (!(scale > 0)) return std::nullopt;
  return std::visit(KnownShapeFinder{scale}, shape.geometry);
}

std::vector<AddedMassPart> estimateParts(TriangleMesh mesh, const Matrix6& added_mass) {
  const MeshProperties properties = computeMassProperties(mesh);
  mesh.vertices.colwise() -= properties.uniform.centre;
  const Matrix6 about_centre = shiftOrigin(added_mass, properties.uniform.centre);
  return placed(joinPanels(simplePanels(mesh, about_centre.diagonal())), 1,
                properties.uniform.centre);
}

}  // namespace ambient
