#include "preprocess/collision_shape/shape_parts.h"

#include <BulletCollision/Gimpact/btGImpactShape.h>
#include <btBulletCollisionCommon.h>

#include <cmath>
#include <utility>

#include "bullet_ambient/bullet/conversions.h"
#include "preprocess/collision_shape/shape_refusal.h"
#include "preprocess/mesh/input_error.h"

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {
namespace {

using Points = std::vector<Eigen::Vector3d>;

Matrix3 toMatrix(const btMatrix3x3& basis) {
  Matrix3 matrix;
  for (int i = 0; i < 3; ++i) matrix.row(i) = toVector3(basis.getRow(i));
  return matrix;
}

/// Where a shape is, and what begins messages about it.
struct Place {
  Matrix3 rotation = Matrix3::Identity();
  Vector3 translation = Vector3::Zero();
  double scale = 1;
  std::string name = {};
  std::string part = {};  ///< "child 1: child 0" in a compound

  Place child(int i, const btTransform& transform) const {
    const std::string number = ": child " + std::to_string(i);
    return {rotation * toMatrix(transform.getBasis()),
            translation + scale * rotation * toVector3(transform.getOrigin()), scale, name + number,
            (part + number).substr(part.empty() ? 2 : 0)};
  }
};

/// Turns the z axis to axis x, y or z.
Matrix3 axisAlong(int up_axis) {
  Matrix3 turn = Matrix3::Zero();
  for (int k = 0; k < 3; ++k) turn((up_axis + 1 + k) % 3, k) = 1;
  return turn;
}

ShapePart partOf(PartKind kind, std::vector<double> sizes) {
  ShapePart part;
  part.kind = kind;
  part.sizes = std::move(sizes);
  return part;
}

ShapePart alongAxis(ShapePart part, int up_axis) {
  part.rotation = axisAlong(up_axis);
  return part;
}

void appendCorners(const btGImpactShapeInterface& mesh, Points& corners) {
  mesh.lockChildShapes();
  for (int t = 0; t < mesh.getNumChildShapes(); ++t) {
    btTriangleShapeEx triangle;
    mesh.getBulletTriangle(t, triangle);
    for (const btVector3& corner : triangle.m_vertices1) corners.push_back(toVector3(corner));
  }
  mesh.unlockChildShapes();
}

/// Takes the corners of all triangles of a btStridingMeshInterface, scaled.
struct CornerCollector : btInternalTriangleIndexCallback {
  Points points;

  void internalProcessTriangleIndex(btVector3* triangle, int, int) override {
    for (int k = 0; k < 3; ++k) points.push_back(toVector3(triangle[k]));
  }
};

/// Walks through a shape and collects its parts.
class PartCollector {
 public:
  explicit PartCollector(bool margins) : margins_(margins) {}

  void add(const btCollisionShape& shape, const Place& place) {
    switch (shape.getShapeType()) {
      case COMPOUND_SHAPE_PROXYTYPE:
        return addCompound(static_cast<const btCompoundShape&>(shape), place);
      case UNIFORM_SCALING_SHAPE_PROXYTYPE:
        return addScaled(static_cast<const btUniformScalingShape&>(shape), place);
      case GIMPACT_SHAPE_PROXYTYPE:
        return addGImpact(static_cast<const btGImpactShapeInterface&>(shape), place);
      default:
        take(readConvex(shape, place.name), shape, place);
    }
  }

  std::vector<ShapePart> parts() const { return parts_; }

 private:
  void take(const ShapePart& part, const btCollisionShape& shape, const Place& place) {
    parts_.push_back(scaled({part}, place.scale).front());
    ShapePart& taken = parts_.back();
    taken.rotation = place.rotation * part.rotation;
    taken.translation = place.translation;
    taken.name = place.name;
    if (!place.part.empty()) taken.part = place.part + " (" + shape.getName() + ")";
  }

  void addCompound(const btCompoundShape& compound, const Place& place) {
    const int count = compound.getNumChildShapes();
    if (count == 0) raiseInputError(place.name, "a compound shape without children is empty");
    for (int i = 0; i < count; ++i) {
      if (!compound.getChildShape(i))
        raiseInputError(place.name, "child ", i, " of the compound shape is null");
      add(*compound.getChildShape(i), place.child(i, compound.getChildTransform(i)));
    }
  }

  void addScaled(const btUniformScalingShape& shape, const Place& place) {
    const auto factor = static_cast<double>(shape.getUniformScalingFactor());
    if (!(factor > 0))
      raiseInputError(place.name, "the scaling factor ", factor, " is not positive");
    Place inside = place;
    inside.scale *= factor;
    add(*shape.getChildShape(), inside);
  }

  void addGImpact(const btGImpactShapeInterface& shape, const Place& place) {
    if (shape.getGImpactShapeType() == CONST_GIMPACT_COMPOUND_SHAPE) {
      const auto& compound = static_cast<const btGImpactCompoundShape&>(shape);
      for (int i = 0; i < compound.getNumChildShapes(); ++i) {
        add(*compound.getChildShape(i), place.child(i, compound.getChildTransform(i)));
      }
      return;
    }
    ShapePart part = partOf(PartKind::kMesh, {});
    if (shape.getGImpactShapeType() == CONST_GIMPACT_TRIMESH_SHAPE) {
      const auto& mesh = static_cast<const btGImpactMeshShape&>(shape);
      for (int i = 0; i < mesh.getMeshPartCount(); ++i)
        appendCorners(*mesh.getMeshPart(i), part.points);
    } else {
      appendCorners(shape, part.points);
    }
    take(part, shape, place);
  }

  ShapePart readConvex(const btCollisionShape& shape, const std::string& name) const {
    switch (shape.getShapeType()) {
      case SPHERE_SHAPE_PROXYTYPE:
        return partOf(PartKind::kBall, {static_cast<const btSphereShape&>(shape).getRadius()});
      case BOX_SHAPE_PROXYTYPE: {
        const Vector3 half =
            toVector3(static_cast<const btBoxShape&>(shape).getHalfExtentsWithMargin());
        return partOf(PartKind::kBox, {half.x(), half.y(), half.z()});
      }
      case CYLINDER_SHAPE_PROXYTYPE: {
        const auto& cylinder = static_cast<const btCylinderShape&>(shape);
        const int axis = cylinder.getUpAxis();
        const auto half_height = static_cast<double>(cylinder.getHalfExtentsWithMargin()[axis]);
        return alongAxis(partOf(PartKind::kCylinder, {cylinder.getRadius(), 2 * half_height}),
                         axis);
      }
      case CAPSULE_SHAPE_PROXYTYPE: {
        const auto& capsule = static_cast<const btCapsuleShape&>(shape);
        const auto half_height = static_cast<double>(capsule.getHalfHeight());
        return alongAxis(partOf(PartKind::kCapsule, {capsule.getRadius(), 2 * half_height}),
                         capsule.getUpAxis());
      }
      case CONE_SHAPE_PROXYTYPE: {
        const auto& cone = static_cast<const btConeShape&>(shape);
        ShapePart part = partOf(PartKind::kCone, {cone.getRadius(), cone.getHeight()});
        part.margin = marginOf(shape);
        return alongAxis(part, cone.getConeUpIndex());
      }
      case MULTI_SPHERE_SHAPE_PROXYTYPE:
        return readBalls(static_cast<const btMultiSphereShape&>(shape), name);
      case CONVEX_HULL_SHAPE_PROXYTYPE:
        return readHull(static_cast<const btConvexHullShape&>(shape));
      case CONVEX_TRIANGLEMESH_SHAPE_PROXYTYPE:
      case TETRAHEDRAL_SHAPE_PROXYTYPE:
        return readPolyhedron(static_cast<const btPolyhedralConvexShape&>(shape));
      default:
        refuseShape(shape, name);
    }
  }

  double marginOf(const btCollisionShape& shape) const {
    return margins_ ? static_cast<double>(shape.getMargin()) : 0;
  }

  static ShapePart readBalls(const btMultiSphereShape& shape, const std::string& name) {
    const Vector3 scaling = toVector3(shape.getLocalScaling());
    ShapePart part = partOf(PartKind::kBallHull, {});
    for (int i = 0; i < shape.getSphereCount(); ++i) {
      const auto radius = static_cast<double>(shape.getSphereRadius(i));
      part.points.emplace_back(scaling.cwiseProduct(toVector3(shape.getSpherePosition(i))));
      for (const double factor : scaling) part.sizes.push_back(radius * std::abs(factor));
    }
    if (part.points.empty()) raiseInputError(name, "a multi-sphere shape without spheres is empty");
    return part;
  }

  // Scaled in double, so that scaled hulls have one form.
  ShapePart readHull(const btConvexHullShape& shape) const {
    const Vector3 scaling = toVector3(shape.getLocalScalingNV());
    ShapePart part = partOf(PartKind::kHull, {});
    part.margin = marginOf(shape);
    for (int i = 0; i < shape.getNumPoints(); ++i) {
      part.points.emplace_back(scaling.cwiseProduct(toVector3(shape.getUnscaledPoints()[i])));
    }
    return part;
  }

  ShapePart readPolyhedron(const btPolyhedralConvexShape& shape) const {
    ShapePart part = partOf(PartKind::kHull, {});
    part.margin = marginOf(shape);
    if (shape.getShapeType() == CONVEX_TRIANGLEMESH_SHAPE_PROXYTYPE) {
      // It knows its triangles only.
      CornerCollector corners;
      const btScalar far(BT_LARGE_FLOAT);
      static_cast<const btConvexTriangleMeshShape&>(shape)
          .getMeshInterface()
          ->InternalProcessAllTriangles(&corners, {-far, -far, -far}, {far, far, far});
      part.points = corners.points;
    }
    btVector3 vertex;
    for (int i = 0; i < shape.getNumVertices(); ++i) {
      shape.getVertex(i, vertex);
      part.points.push_back(toVector3(vertex));
    }
    return part;
  }

  bool margins_;
  std::vector<ShapePart> parts_;
};

}  // namespace

std::vector<ShapePart> readShapeParts(const btCollisionShape& shape, bool margins,
                                      const std::string& name) {
  PartCollector collector(margins);
  Place place;
  place.name = name;
  collector.add(shape, place);
  return collector.parts();
}

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
