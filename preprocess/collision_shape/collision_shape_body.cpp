#include "preprocess/collision_shape/collision_shape_body.h"

#include <BulletCollision/Gimpact/btGImpactShape.h>
#include <btBulletCollisionCommon.h>

#include <cmath>

#include "bullet_ambient/bullet/core/conversions.h"
#include "preprocess/collision_shape/form_body.h"
#include "preprocess/mesh/input_error.h"

AMBIENT_BEGIN

namespace {

using Points = std::vector<Eigen::Vector3d>;

Matrix3 toMatrix(const btMatrix3x3& basis) {
  Matrix3 matrix;
  for (int i = 0; i < 3; ++i) matrix.row(i) = toVector3(basis.getRow(i));
  return matrix;
}

/// Says why a shape that has no solids cannot be a body in a fluid, and what to use instead.
/// @throws std::runtime_error always, in one line that begins with `name`.
[[noreturn]] void refuseShape(const btCollisionShape& shape, const std::string& name) {
  const std::string kind = shape.getName();
  switch (shape.getShapeType()) {
    case STATIC_PLANE_PROXYTYPE:
      raiseInputError(name, "a plane (", kind, ") is unbounded and cannot move in a fluid");
    case TERRAIN_SHAPE_PROXYTYPE:
      raiseInputError(name, "a height field (", kind,
                      ") encloses no volume and cannot move in a fluid");
    case TRIANGLE_MESH_SHAPE_PROXYTYPE:
    case SCALED_TRIANGLE_MESH_SHAPE_PROXYTYPE:
    case MULTIMATERIAL_TRIANGLE_MESH_PROXYTYPE:
      raiseInputError(name, "a static triangle mesh (", kind,
                      ") cannot move in Bullet: use btGImpactMeshShape or convex hulls");
    case EMPTY_SHAPE_PROXYTYPE:
      raiseInputError(name, "an empty shape (", kind, ") displaces no fluid");
    case SOFTBODY_SHAPE_PROXYTYPE:
      raiseInputError(name, "a soft body (", kind, ") has no rigid shape");
    default:
      raiseInputError(name, "a shape of type ", kind, " (", shape.getShapeType(),
                      ") is not supported: use a convex hull or a btGImpactMeshShape");
  }
}

/// Place and scale of a shape in the frame of the outermost one, and the name that begins messages
/// about it.
struct Place {
  Matrix3 rotation = Matrix3::Identity();
  Vector3 translation = Vector3::Zero();
  double scale = 1;
  std::string name = {};
  bool is_child = false;  ///< of a compound

  Place child(int i, const btTransform& transform) const {
    return {rotation * toMatrix(transform.getBasis()),
            translation + scale * rotation * toVector3(transform.getOrigin()), scale,
            name + ": child " + std::to_string(i), true};
  }
};

/// Turns the z axis to axis x, y or z.
Matrix3 axisAlong(int up_axis) {
  Matrix3 turn = Matrix3::Zero();
  for (int k = 0; k < 3; ++k) turn((up_axis + 1 + k) % 3, k) = 1;
  return turn;
}

PlacedShape alongAxis(const Shape& shape, int up_axis) {
  PlacedShape part{shape};
  part.pose.linear() = axisAlong(up_axis);
  return part;
}

/// Two equal balls are the ends of a capsule; other hulls of balls stay what they are.
PlacedShape asCapsule(const BallHull& hull) {
  if (hull.balls.size() != 2) return {hull};
  const BallHull::Ball &first = hull.balls[0], &last = hull.balls[1];
  const double radius = first.semi_axes[0];
  for (const BallHull::Ball& ball : hull.balls)
    if (ball.semi_axes != Vector3::Constant(radius)) return {hull};
  const Vector3 way = last.centre - first.centre;
  PlacedShape part{Capsule{radius, way.norm()}};
  if (!way.isZero(0)) part.pose.linear() = axesAlong(way.normalized());
  part.pose.translation() = (first.centre + last.centre) / 2;
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

  std::vector<PlacedShape> takeParts() { return std::move(parts_); }

 private:
  void take(const PlacedShape& part, const btCollisionShape& shape, const Place& place) {
    parts_.push_back(scaled(part, place.scale));
    PlacedShape& taken = parts_.back();
    taken.pose.linear() = place.rotation * part.pose.linear();
    taken.pose.translation() = place.translation + place.rotation * taken.pose.translation();
    taken.name = place.name;
    if (place.is_child) taken.name += std::string(" (") + shape.getName() + ")";
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
    TriangleSoup soup;
    if (shape.getGImpactShapeType() == CONST_GIMPACT_TRIMESH_SHAPE) {
      const auto& mesh = static_cast<const btGImpactMeshShape&>(shape);
      for (int i = 0; i < mesh.getMeshPartCount(); ++i)
        appendCorners(*mesh.getMeshPart(i), soup.corners);
    } else {
      appendCorners(shape, soup.corners);
    }
    take({soup}, shape, place);
  }

  static PlacedShape readConvex(const btCollisionShape& shape, const std::string& name) {
    switch (shape.getShapeType()) {
      case SPHERE_SHAPE_PROXYTYPE:
        return {Sphere{static_cast<const btSphereShape&>(shape).getRadius()}};
      case BOX_SHAPE_PROXYTYPE:
        return {Box{toVector3(static_cast<const btBoxShape&>(shape).getHalfExtentsWithMargin())}};
      case CYLINDER_SHAPE_PROXYTYPE: {
        const auto& cylinder = static_cast<const btCylinderShape&>(shape);
        const int axis = cylinder.getUpAxis();
        const auto half_height = static_cast<double>(cylinder.getHalfExtentsWithMargin()[axis]);
        return alongAxis(Cylinder{cylinder.getRadius(), 2 * half_height}, axis);
      }
      case CAPSULE_SHAPE_PROXYTYPE: {
        const auto& capsule = static_cast<const btCapsuleShape&>(shape);
        const auto half_height = static_cast<double>(capsule.getHalfHeight());
        return alongAxis(Capsule{capsule.getRadius(), 2 * half_height}, capsule.getUpAxis());
      }
      case CONE_SHAPE_PROXYTYPE: {
        const auto& cone = static_cast<const btConeShape&>(shape);
        return alongAxis(Cone{cone.getRadius(), cone.getHeight()}, cone.getConeUpIndex());
      }
      case MULTI_SPHERE_SHAPE_PROXYTYPE:
        return asCapsule(readBalls(static_cast<const btMultiSphereShape&>(shape), name));
      case CONVEX_HULL_SHAPE_PROXYTYPE:
        return {readHull(static_cast<const btConvexHullShape&>(shape))};
      case CONVEX_TRIANGLEMESH_SHAPE_PROXYTYPE:
      case TETRAHEDRAL_SHAPE_PROXYTYPE:
        return {readPolyhedron(static_cast<const btPolyhedralConvexShape&>(shape))};
      default:
        refuseShape(shape, name);
    }
  }

  static BallHull readBalls(const btMultiSphereShape& shape, const std::string& name) {
    const Vector3 scaling = toVector3(shape.getLocalScaling());
    BallHull hull;
    for (int i = 0; i < shape.getSphereCount(); ++i) {
      const auto radius = static_cast<double>(shape.getSphereRadius(i));
      hull.balls.push_back({scaling.cwiseProduct(toVector3(shape.getSpherePosition(i))),
                            radius * scaling.cwiseAbs()});
    }
    if (hull.balls.empty()) raiseInputError(name, "a multi-sphere shape without spheres is empty");
    return hull;
  }

  // Scaled in double, so that scaled hulls have one form.
  static Hull readHull(const btConvexHullShape& shape) {
    const Vector3 scaling = toVector3(shape.getLocalScalingNV());
    Hull hull;
    hull.points.reserve(static_cast<std::size_t>(shape.getNumPoints()));
    for (int i = 0; i < shape.getNumPoints(); ++i) {
      hull.points.emplace_back(scaling.cwiseProduct(toVector3(shape.getUnscaledPoints()[i])));
    }
    return hull;
  }

  static Hull readPolyhedron(const btPolyhedralConvexShape& shape) {
    Hull hull;
    if (shape.getShapeType() == CONVEX_TRIANGLEMESH_SHAPE_PROXYTYPE) {
      // This kind of shape gives triangles only, no list of points.
      CornerCollector corners;
      const btScalar far(BT_LARGE_FLOAT);
      static_cast<const btConvexTriangleMeshShape&>(shape)
          .getMeshInterface()
          ->InternalProcessAllTriangles(&corners, {-far, -far, -far}, {far, far, far});
      hull.points = corners.points;
    }
    btVector3 vertex;
    for (int i = 0; i < shape.getNumVertices(); ++i) {
      shape.getVertex(i, vertex);
      hull.points.push_back(toVector3(vertex));
    }
    return hull;
  }

  std::vector<PlacedShape> parts_;
};

}  // namespace

ShapeForm readForm(const btCollisionShape& shape, const CollisionShapeSettings& settings) {
  const std::string name = settings.name.empty() ? shape.getName() : settings.name;
  requireUsable(settings, name);
  PartCollector collector;
  Place place;
  place.name = name;
  collector.add(shape, place);
  ShapeForm form{shape.getName(), collector.takeParts(), 1};
  requireUsualNumbers(form.parts);
  return form;
}

FluidBody makeFluidBody(const btCollisionShape& shape, const CollisionShapeSettings& settings) {
  FluidBody body = makeFormBody(recognised(readForm(shape, settings)), settings);
  if (settings.report)
    for (const std::string& line : body.provenance.said) settings.report(line);
  return body;
}

Provenance describeCollisionShape(const btCollisionShape& shape,
                                  const CollisionShapeSettings& settings) {
  return describeForm(recognised(readForm(shape, settings)), settings);
}

AMBIENT_END
