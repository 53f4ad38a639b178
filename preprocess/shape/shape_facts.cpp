#include "preprocess/shape/shape_facts.h"

#include <cmath>
#include <sstream>

#include "bullet_ambient/base/pi.h"
#include "preprocess/added_mass_tables/known_added_mass.h"
#include "preprocess/mesh/input_error.h"
#include "preprocess/mesh/mass_properties.h"
#include "preprocess/mesh/shapes/primitive_limits.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "preprocess/mesh/usual_size.h"
#include "preprocess/potential_flow/results/ellipsoid_added_mass.h"

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

}  // namespace ambient
