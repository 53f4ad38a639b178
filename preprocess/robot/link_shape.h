#pragma once

#include <BulletCollision/CollisionShapes/btCompoundShape.h>

#include <memory>
#include <vector>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "preprocess/robot/robot_model.h"

AMBIENT_BEGIN

/// Collision shapes of a link. Bullet's body frame B has its origin in the link's centre of mass
/// and its axes along the principal axes of inertia.
struct LinkShape {
  std::vector<std::unique_ptr<btCollisionShape>> parts;
  std::unique_ptr<btCompoundShape> in_body;  ///< in B: the shape of the link's collider
  std::unique_ptr<btCompoundShape> in_link;  ///< in the link's frame, to make fluid bodies of

  bool isEmpty() const { return parts.empty(); }
};

/// Spheres, boxes, ellipsoids, cylinders and capsules as they are; of a mesh the convex hull. The
/// margin is one percent of the least size. Cost: that of reading the mesh files.
/// @throws std::runtime_error in one line that names the file.
LinkShape makeLinkShape(const LinkModel& link, const RigidPose& link_in_body);

/// The pose of the link's frame in B, and the moments of inertia in B [kg m^2].
struct LinkMassFrame {
  RigidPose link_in_body = RigidPose::Identity();
  Vector3 moments{0, 0, 0};
};
LinkMassFrame findMassFrame(const LinkModel& link);

btTransform toBulletTransform(const RigidPose& pose);
RigidPose toPose(const btTransform& transform);

AMBIENT_END
