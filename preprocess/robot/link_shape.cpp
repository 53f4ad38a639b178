#include "preprocess/robot/link_shape.h"

#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/CollisionShapes/btMultiSphereShape.h>

#include "bullet_ambient/bullet/core/conversions.h"
#include "bullet_ambient/spatial/symmetric_eigen.h"
#include "preprocess/mesh/import/mesh_import.h"
#include "preprocess/mesh/input_error.h"

AMBIENT_BEGIN

namespace {

/// Bullet's shape of a part, in its own frame.
struct PartMaker : PrimitiveMaker {
  const std::string& source;

  explicit PartMaker(const std::string& of) : source(of) {}
  using PrimitiveMaker::operator();
  Made operator()(const Ellipsoid& s) const {
    const btVector3 centre(0, 0, 0);
    const btScalar radius = 1;
    auto ball = std::make_unique<btMultiSphereShape>(&centre, &radius, 1);
    ball->setLocalScaling(toBullet(s.semi_axes));
    return withMargin(std::move(ball), s.semi_axes.minCoeff());
  }
  Made operator()(const MeshFile& mesh) const {
    const Eigen::Matrix3Xd points = mesh.stretch.asDiagonal() * importMesh(mesh.file).mesh.vertices;
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
  template <class Other>
  Made operator()(const Other&) const {
    raiseInputError(source, "this kind of shape cannot be a part of a link");
  }
};

}  // namespace

LinkShape makeLinkShape(const LinkModel& link, const RigidPose& link_in_body) {
  LinkShape made;
  made.in_body = std::make_unique<btCompoundShape>();
  made.in_link = std::make_unique<btCompoundShape>();
  for (const PlacedShape& part : link.collisions) {
    made.parts.push_back(std::visit(PartMaker(part.name), part.shape));
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

AMBIENT_END
