#pragma once

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btCapsuleShape.h>
#include <BulletCollision/CollisionShapes/btCompoundShape.h>
#include <BulletCollision/CollisionShapes/btConeShape.h>
#include <BulletCollision/CollisionShapes/btCylinderShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bullet_ambient/bullet/core/conversions.h"
#include "bullet_ambient/bullet/core/precision_check.h"
#include "preprocess/robot/robot_model.h"
#include "preprocess/shape/shapes.h"

AMBIENT_BEGIN

/// Visitor that makes Bullet's convex primitive of a simple shape, in the shape's frame. Derive
/// from it to handle other shapes.
struct PrimitiveMaker {
  using Made = std::unique_ptr<btConvexInternalShape>;

  Made operator()(const Sphere& s) const {
    return std::make_unique<btSphereShape>(static_cast<btScalar>(s.radius));
  }
  Made operator()(const Box& s) const {
    return withMargin(std::make_unique<btBoxShape>(toBullet(s.half_sizes)),
                      s.half_sizes.minCoeff());
  }
  Made operator()(const Cylinder& s) const {
    const Vector3 half_sizes(s.radius, s.radius, s.height / 2);
    return withMargin(std::make_unique<btCylinderShapeZ>(toBullet(half_sizes)),
                      half_sizes.minCoeff());
  }
  Made operator()(const Capsule& s) const {
    return std::make_unique<btCapsuleShapeZ>(static_cast<btScalar>(s.radius),
                                             static_cast<btScalar>(s.height));
  }
  Made operator()(const Cone& s) const {
    return withMargin(std::make_unique<btConeShapeZ>(static_cast<btScalar>(s.radius),
                                                     static_cast<btScalar>(s.height)),
                      std::min(s.radius, s.height / 2));
  }

  /// Returns a margin of a hundredth of a size [m]. A margin shrinks the core of all shapes but
  /// spheres and capsules; Bullet's default of 4 cm is larger than many bodies.
  static btScalar margin(double size) { return static_cast<btScalar>(0.01 * size); }
  static Made withMargin(Made shape, double size) {
    shape->setMargin(margin(size));
    return shape;
  }
};

/// Collision shapes of a link. Bullet's body frame B has its origin in the link's centre of mass
/// and its axes along the principal axes of inertia.
struct LinkShape {
  std::vector<std::unique_ptr<btCollisionShape>> parts;
  std::unique_ptr<btCompoundShape> in_body;  ///< shape of the link's collider, in B
  std::unique_ptr<btCompoundShape>
      in_link;                        ///< the same shape in the link's frame, for fluid bodies
  std::vector<std::string> warnings;  ///< of hulls that are much larger than their meshes

  bool isEmpty() const { return parts.empty(); }
};

/// Makes the collision shapes of a link: spheres, boxes, ellipsoids, cylinders and capsules as they
/// are; a mesh becomes its convex hull, one of several objects a hull of each, as by Bullet's own
/// importer. The margin is one per cent of the least size. Cost: that of reading the mesh files.
/// @throws std::runtime_error in one line that names the file.
LinkShape makeLinkShape(const LinkModel& link, const RigidPose& link_in_body);

/// Pose of the link's frame in B, and principal moments of inertia [kg m^2].
struct LinkMassFrame {
  RigidPose link_in_body = RigidPose::Identity();
  Vector3 moments{0, 0, 0};
};
LinkMassFrame findMassFrame(const LinkModel& link);

btTransform toBulletTransform(const RigidPose& pose);
RigidPose toPose(const btTransform& transform);

AMBIENT_END
