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
  std::unique_ptr<btCompoundShape> in_body;  ///< shape of the link's collider, in B
  std::unique_ptr<btCompoundShape>
      in_link;  ///< the same shape in the link's frame, for fluid bodies

  bool isEmpty() const { return parts.empty(); }
};

/// Makes the collision shapes of a link: spheres, boxes, ellipsoids, cylinders and capsules as they
/// are; a mesh becomes its convex hull. The margin is one per cent of the least size. Cost: that of
/// reading the mesh files.
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
