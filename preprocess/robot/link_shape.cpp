#include "preprocess/robot/link_shape.h"

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btCapsuleShape.h>
#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/CollisionShapes/btCylinderShape.h>
#include <BulletCollision/CollisionShapes/btMultiSphereShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>

#include <algorithm>

#include "bullet_ambient/bullet/conversions.h"
#include "bullet_ambient/spatial/principal_frame.h"
#include "preprocess/mesh/input_error.h"
#include "preprocess/mesh/mesh_import.h"

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {
namespace {

constexpr double kLinkMarginShare = 0.01;

btScalar shapeScalar(double value) { return static_cast<btScalar>(value); }

/// Bullet's shape of a part, in its own frame.
struct PartMaker {
  using Made = std::unique_ptr<btCollisionShape>;
  const std::string& source;

  Made operator()(const SphereShape& s) const {
    return std::make_unique<btSphereShape>(shapeScalar(s.radius));
  }
  Made operator()(const BoxShape& s) const {
    return withMargin(std::make_unique<btBoxShape>(toBullet(s.half_sizes)),
                      s.half_sizes.minCoeff());
  }
  Made operator()(const EllipsoidShape& s) const {
    const btVector3 centre(0, 0, 0);
    const btScalar radius = 1;
    auto ball = std::make_unique<btMultiSphereShape>(&centre, &radius, 1);
    ball->setLocalScaling(toBullet(s.semi_axes));
    return withMargin(std::move(ball), s.semi_axes.minCoeff());
  }
  Made operator()(const CylinderShape& s) const {
    const Vector3 half_sizes(s.radius, s.radius, s.height / 2);
    return withMargin(std::make_unique<btCylinderShapeZ>(toBullet(half_sizes)),
                      half_sizes.minCoeff());
  }
  Made operator()(const CapsuleShape& s) const {
    return std::make_unique<btCapsuleShapeZ>(shapeScalar(s.radius), shapeScalar(s.height));
  }
  Made operator()(const MeshHull& mesh) const {
    const Eigen::Matrix3Xd points =
        Eigen::Vector3d(mesh.scale).asDiagonal() * importMesh(mesh.file).mesh.vertices;
    const Eigen::Vector3d extents = points.rowwise().maxCoeff() - points.rowwise().minCoeff();
    if (!(extents.minCoeff() > 0))
      raiseInputError(source, "the mesh ", mesh.file.string(),
                      " is flat; the convex hull of a mesh must have a volume");
    auto hull = std::make_unique<btConvexHullShape>();
    for (Eigen::Index i = 0; i < points.cols(); ++i)
      hull->addPoint(toBullet(Vector3(points.col(i))), false);
    hull->setMargin(0);
    hull->optimizeConvexHull();
    return withMargin(std::move(hull), extents.minCoeff() / 2);
  }

  template <class Shape>
  static Made withMargin(std::unique_ptr<Shape> shape, double half_size) {
    shape->setMargin(shapeScalar(kLinkMarginShare * half_size));
    return shape;
  }
};

}  // namespace

LinkShape makeLinkShape(const LinkModel& link, const RigidPose& link_in_body) {
  LinkShape made;
  made.in_body = std::make_unique<btCompoundShape>();
  made.in_link = std::make_unique<btCompoundShape>();
  for (const CollisionPart& part : link.collisions) {
    made.parts.push_back(std::visit(PartMaker{part.source}, part.shape));
    btCollisionShape* shape = made.parts.back().get();
    made.in_link->addChildShape(toBulletTransform(part.pose), shape);
    made.in_body->addChildShape(toBulletTransform(link_in_body * part.pose), shape);
  }
  return made;
}

LinkMassFrame findMassFrame(const LinkModel& link) {
  LinkMassFrame frame;
  const PrincipalFrame principal =
      link.inertia.isZero(0) ? PrincipalFrame{} : findPrincipalFrame(link.inertia);
  frame.moments = principal.moments;
  frame.link_in_body.linear() = principal.rotation.transpose();
  frame.link_in_body.translation() = principal.rotation.transpose() * -link.centre_of_mass;
  return frame;
}

btTransform toBulletTransform(const RigidPose& pose) {
  return btTransform(toBulletMatrix(pose.linear()), toBullet(Vector3(pose.translation())));
}

RigidPose toPose(const btTransform& transform) {
  RigidPose pose = RigidPose::Identity();
  pose.linear() = toQuaternion(transform.getRotation()).toRotationMatrix();
  pose.translation() = toVector3(transform.getOrigin());
  return pose;
}

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
