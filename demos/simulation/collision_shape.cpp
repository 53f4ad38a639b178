#include "demos/simulation/collision_shape.h"

#include <algorithm>

#include "bullet_ambient/bullet/conversions.h"

namespace ambient {
namespace {

// Bullet's default margin of 4 cm is larger than many of our bodies.
constexpr double kMarginShare = 0.01;

btScalar scalar(double value) { return static_cast<btScalar>(value); }

/// The convex primitive of Bullet for a shape that is one, else null. A margin shrinks the core of
/// all but spheres and capsules.
struct PrimitiveMaker {
  using Made = std::unique_ptr<btConvexInternalShape>;

  Made operator()(const SphereShape& s) const {
    return std::make_unique<btSphereShape>(scalar(s.radius));
  }
  Made operator()(const BoxShape& s) const {
    return withMargin(std::make_unique<btBoxShape>(toBullet(s.half_sizes)),
                      s.half_sizes.minCoeff());
  }
  Made operator()(const CylinderShape& s) const {
    const Vector3 half_sizes(s.radius, s.radius, s.height / 2);
    return withMargin(std::make_unique<btCylinderShapeZ>(toBullet(half_sizes)),
                      half_sizes.minCoeff());
  }
  Made operator()(const CapsuleShape& s) const {
    return std::make_unique<btCapsuleShapeZ>(scalar(s.radius), scalar(s.height));
  }
  Made operator()(const ConeShape& s) const {
    return withMargin(std::make_unique<btConeShapeZ>(scalar(s.radius), scalar(s.height)),
                      std::min(s.radius, s.height / 2));
  }
  template <class Other>
  Made operator()(const Other&) const {
    return nullptr;
  }

  static Made withMargin(Made shape, double smallest) {
    shape->setMargin(scalar(kMarginShare * smallest));
    return shape;
  }
};

std::unique_ptr<btCollisionShape> makeHull(const Surface& surface) {
  auto hull = std::make_unique<btConvexHullShape>();
  const auto count = static_cast<Eigen::Index>(surface.vertices.size() / 3);
  const Eigen::Map<const Eigen::Matrix3Xd> points(surface.vertices.data(), 3, count);
  for (Eigen::Index i = 0; i < count; ++i) hull->addPoint(toBullet(points.col(i)), false);
  const Vector3 extents = points.rowwise().maxCoeff() - points.rowwise().minCoeff();
  // A flat sheet has no thickness of its own: then the margin is one percent of its length.
  const double smallest = extents.minCoeff() > 0 ? extents.minCoeff() : extents.maxCoeff();
  hull->setMargin(scalar(kMarginShare * smallest));
  hull->recalcLocalAabb();
  return hull;
}

std::unique_ptr<btTriangleMesh> makeTriangles(const Surface& surface) {
  auto mesh = std::make_unique<btTriangleMesh>();
  const auto corner = [&](std::size_t i) {
    return toBullet(Eigen::Map<const Vector3>(&surface.vertices[3 * surface.triangles[i]]));
  };
  for (std::size_t i = 0; i + 2 < surface.triangles.size(); i += 3)
    mesh->addTriangle(corner(i), corner(i + 1), corner(i + 2));
  return mesh;
}

bool isIdentity(const btTransform& transform) {
  return transform.getOrigin().isZero() && transform.getBasis() == btMatrix3x3::getIdentity();
}

}  // namespace

CollisionShape makeCollisionShape(const BodyDef& def, const PreparedBody& prepared,
                                  const btTransform& S_in_B) {
  CollisionShape shape;
  if (auto primitive = std::visit(PrimitiveMaker{}, def.shape.geometry)) {
    shape.parts.push_back(std::move(primitive));
  } else if (prepared.mass > 0) {
    shape.parts.push_back(makeHull(prepared.surface));
  } else {
    shape.triangles = makeTriangles(prepared.surface);
    shape.parts.push_back(std::make_unique<btBvhTriangleMeshShape>(shape.triangles.get(), true));
  }
  // Bullet takes a contact of two plain shapes into a step when it is within its threshold of 2 cm,
  // and a bounce loses what is left of the gap; children of compounds wait until their boxes meet.
  if (prepared.mass == 0 && isIdentity(S_in_B)) return shape;
  auto compound = std::make_unique<btCompoundShape>();
  compound->addChildShape(S_in_B, shape.parts.back().get());
  shape.parts.push_back(std::move(compound));
  return shape;
}

}  // namespace ambient
