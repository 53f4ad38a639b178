#include "demos/simulation/collision_shape.h"

#include <algorithm>

#include "bullet_ambient/bullet/conversions.h"

namespace ambient {
namespace {

// Bullet's default margin of 4 cm is larger than many of our bodies.
constexpr double kMarginShare = 0.01;

btScalar scalar(double value) { return static_cast<btScalar>(value); }

double smallestExtent(const std::vector<Vector3>& points) {
  Vector3 low = points.front();
  Vector3 high = points.front();
  for (const Vector3& point : points) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  // A flat sheet has no thickness of its own: then the margin is one percent of its length.
  const double smallest = (high - low).minCoeff();
  return smallest > 0 ? smallest : (high - low).maxCoeff();
}

std::unique_ptr<btCollisionShape> makeHull(const std::vector<Vector3>& points) {
  auto hull = std::make_unique<btConvexHullShape>();
  for (const Vector3& point : points) hull->addPoint(toBullet(point), false);
  hull->setMargin(scalar(kMarginShare * smallestExtent(points)));
  hull->recalcLocalAabb();
  return hull;
}

std::unique_ptr<btTriangleMesh> makeTriangles(const CollisionGeometry& geometry) {
  auto mesh = std::make_unique<btTriangleMesh>();
  const auto corner = [&](std::size_t i) {
    return toBullet(geometry.points[static_cast<std::size_t>(geometry.triangles[i])]);
  };
  for (std::size_t i = 0; i + 2 < geometry.triangles.size(); i += 3)
    mesh->addTriangle(corner(i), corner(i + 1), corner(i + 2));
  return mesh;
}

std::unique_ptr<btCollisionShape> makePrimitive(const CollisionGeometry& geometry) {
  using Kind = CollisionGeometry::Kind;
  const btVector3 size = toBullet(geometry.size);
  switch (geometry.kind) {
    case Kind::kSphere:
      return std::make_unique<btSphereShape>(size.x());
    case Kind::kBox:
      return std::make_unique<btBoxShape>(size);
    case Kind::kCylinder:
      return std::make_unique<btCylinderShapeZ>(btVector3(size.x(), size.x(), size.z() / 2));
    case Kind::kCapsule:
      return std::make_unique<btCapsuleShapeZ>(size.x(), size.z());
    default:
      return std::make_unique<btConeShapeZ>(size.x(), size.z());
  }
}

std::unique_ptr<btCollisionShape> makeConvex(const CollisionGeometry& geometry) {
  using Kind = CollisionGeometry::Kind;
  if (geometry.kind == Kind::kConvexHull) return makeHull(geometry.points);
  auto shape = makePrimitive(geometry);
  if (geometry.kind == Kind::kBox || geometry.kind == Kind::kCylinder ||
      geometry.kind == Kind::kCone) {
    const double smallest = geometry.kind == Kind::kBox
                                ? geometry.size.minCoeff()
                                : std::min(geometry.size.x(), geometry.size.z() / 2);
    shape->setMargin(scalar(kMarginShare * smallest));
  }
  return shape;
}

bool isIdentity(const btTransform& transform) {
  return transform.getOrigin().isZero() && transform.getBasis() == btMatrix3x3::getIdentity();
}

}  // namespace

CollisionShape makeCollisionShape(const CollisionGeometry& geometry, const btTransform& S_in_B) {
  CollisionShape shape;
  if (geometry.kind == CollisionGeometry::Kind::kTriangles) {
    shape.triangles = makeTriangles(geometry);
    shape.parts.push_back(std::make_unique<btBvhTriangleMeshShape>(shape.triangles.get(), true));
  } else {
    shape.parts.push_back(makeConvex(geometry));
  }
  if (isIdentity(S_in_B)) return shape;
  auto compound = std::make_unique<btCompoundShape>();
  compound->addChildShape(S_in_B, shape.parts.back().get());
  shape.parts.push_back(std::move(compound));
  return shape;
}

}  // namespace ambient
