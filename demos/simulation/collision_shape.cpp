#include "demos/simulation/collision_shape.h"

#include "bullet_ambient/bullet/core/conversions.h"
#include "preprocess/builder/fluid_body_builder.h"
#include "preprocess/robot/primitive_shape.h"
#include "preprocess/shape/shape_facts.h"

namespace ambient {
namespace {

/// Makes a primitive of Bullet; null for a shape that is none.
struct ShapeMaker : PrimitiveMaker {
  using PrimitiveMaker::operator();
  template <class Other>
  Made operator()(const Other&) const {
    return nullptr;
  }
};

std::unique_ptr<btCollisionShape> makeHull(const Surface& surface) {
  auto hull = std::make_unique<btConvexHullShape>();
  const auto count = static_cast<Eigen::Index>(surface.vertices.size() / 3);
  const Eigen::Map<const Eigen::Matrix3Xd> points(surface.vertices.data(), 3, count);
  for (Eigen::Index i = 0; i < count; ++i) hull->addPoint(toBullet(points.col(i)), false);
  const Vector3 extents = points.rowwise().maxCoeff() - points.rowwise().minCoeff();
  // A flat sheet has no thickness: its margin is one percent of its length.
  const double smallest = extents.minCoeff() > 0 ? extents.minCoeff() : extents.maxCoeff();
  hull->setMargin(PrimitiveMaker::margin(smallest));
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

/// Makes each part as one of Bullet's primitives, or as the hull of its mesh.
CollisionShape makeCompoundShape(const Compound& compound, const btTransform& S_in_B) {
  constexpr int kHullFaces = 320;
  CollisionShape shape;
  auto whole = std::make_unique<btCompoundShape>();
  for (const PlacedShape& part : compound.parts) {
    if (auto primitive = std::visit(ShapeMaker{}, part.shape))
      shape.parts.push_back(std::move(primitive));
    else
      shape.parts.push_back(makeHull(surfaceOf(factsOf(part.shape).mesh(kHullFaces))));
    const btTransform pose(toBullet(Quaternion(part.pose.linear())),
                           toBullet(Vector3(part.pose.translation())));
    whole->addChildShape(S_in_B * pose, shape.parts.back().get());
  }
  shape.parts.push_back(std::move(whole));
  return shape;
}

bool isIdentity(const btTransform& transform) {
  return transform.getOrigin().isZero() && transform.getBasis() == btMatrix3x3::getIdentity();
}

}  // namespace

CollisionShape makeCollisionShape(const BodyDef& def, const PreparedBody& prepared,
                                  const btTransform& S_in_B) {
  if (const auto* compound = std::get_if<Compound>(&def.shape.geometry))
    return makeCompoundShape(*compound, S_in_B);
  CollisionShape shape;
  if (auto primitive = std::visit(ShapeMaker{}, def.shape.geometry)) {
    shape.parts.push_back(std::move(primitive));
  } else if (prepared.mass > 0) {
    shape.parts.push_back(makeHull(prepared.surface));
  } else {
    shape.triangles = makeTriangles(prepared.surface);
    shape.parts.push_back(std::make_unique<btBvhTriangleMeshShape>(shape.triangles.get(), true));
  }
  // Bullet adds contacts of plain shapes at gaps below its threshold of 2 cm, and a bounce loses
  // the remaining gap. For children of compounds Bullet waits until their boxes meet.
  if (prepared.mass == 0 && isIdentity(S_in_B)) return shape;
  auto compound = std::make_unique<btCompoundShape>();
  compound->addChildShape(S_in_B, shape.parts.back().get());
  shape.parts.push_back(std::move(compound));
  return shape;
}

}  // namespace ambient
