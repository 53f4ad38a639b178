#include "demos/simulation/collision_geometry.h"

#include <optional>

#include "bullet_ambient/fluid_body/fluid_body_file.h"
#include "preprocess/shape/shape_mesh.h"

namespace ambient {
namespace {

using Kind = CollisionGeometry::Kind;

CollisionGeometry primitive(Kind kind, const Vector3& size) {
  CollisionGeometry geometry;
  geometry.kind = kind;
  geometry.size = size;
  return geometry;
}

/// Bullet's primitive for a shape that is one.
struct PrimitiveFinder {
  using Found = std::optional<CollisionGeometry>;
  Found operator()(const SphereShape& s) const {
    return primitive(Kind::kSphere, Vector3::Constant(s.radius));
  }
  Found operator()(const BoxShape& s) const { return primitive(Kind::kBox, s.half_sizes); }
  Found operator()(const CylinderShape& s) const {
    return primitive(Kind::kCylinder, {s.radius, s.radius, s.height});
  }
  Found operator()(const CapsuleShape& s) const {
    return primitive(Kind::kCapsule, {s.radius, s.radius, s.height});
  }
  Found operator()(const ConeShape& s) const {
    return primitive(Kind::kCone, {s.radius, s.radius, s.height});
  }
  template <class Other>
  Found operator()(const Other&) const {
    return std::nullopt;
  }
};

CollisionGeometry fromSurface(Kind kind, const Surface& surface, const Vector3& origin) {
  CollisionGeometry geometry;
  geometry.kind = kind;
  const std::vector<double>& v = surface.vertices;
  for (std::size_t i = 0; i + 2 < v.size(); i += 3)
    geometry.points.emplace_back(origin + Vector3(v[i], v[i + 1], v[i + 2]));
  geometry.triangles = surface.triangles;
  return geometry;
}

CollisionGeometry fromMesh(const TriangleMesh& mesh) {
  CollisionGeometry geometry;
  geometry.kind = Kind::kTriangles;
  for (Eigen::Index i = 0; i < mesh.vertexCount(); ++i)
    geometry.points.emplace_back(mesh.vertices.col(i));
  for (Eigen::Index i = 0; i < mesh.triangles.size(); ++i)
    geometry.triangles.push_back(mesh.triangles.data()[i]);
  return geometry;
}

}  // namespace

CollisionGeometry makeDynamicGeometry(const ShapeDescription& shape, const FluidBody& fluid_body,
                                      const Vector3& fluid_origin) {
  if (const auto found = std::visit(PrimitiveFinder{}, shape.geometry)) return *found;
  return fromSurface(Kind::kConvexHull, fluid_body.surface, fluid_origin);
}

CollisionGeometry makeStaticGeometry(const ShapeDescription& shape) {
  if (const auto found = std::visit(PrimitiveFinder{}, shape.geometry)) return *found;
  if (const auto* from_file = std::get_if<FluidBodyShape>(&shape.geometry))
    return fromSurface(Kind::kTriangles, readFluidBody(from_file->file).surface, Vector3::Zero());
  return fromMesh(makeShapeMesh(shape).mesh);
}

}  // namespace ambient
