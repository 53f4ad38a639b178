#pragma once

#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <limits>

#include "bullet_ambient/bullet/core/conversions.h"
#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/immersed/ambient_body.h"
#include "bullet_ambient/motion/rows/axis_locks.h"

AMBIENT_BEGIN

/// Relative rounding of Bullet's numbers, MotionView::rounding.
constexpr auto kBulletRounding = static_cast<double>(std::numeric_limits<btScalar>::epsilon());

/// Reads the velocity of a btRigidBody, world axes.
inline Twist velocityOf(const btRigidBody& body) {
  return {toVector3(body.getAngularVelocity()), toVector3(body.getLinearVelocity())};
}

/// Adds a change to that velocity, in Bullet's arithmetic: impulses that others have applied
/// meanwhile survive.
inline void addVelocity(btRigidBody& body, const Twist& change_W) {
  body.setAngularVelocity(body.getAngularVelocity() + toBullet(change_W.angular));
  body.setLinearVelocity(body.getLinearVelocity() + toBullet(change_W.linear));
}

inline InverseMass inverseMassOf(const btRigidBody& body) {
  return {static_cast<double>(body.getInvMass()), toVector3(body.getInvInertiaDiagLocal())};
}

/// Reads pose and twist of a btRigidBody; pose in W, twist in body axes.
RigidState readState(const btRigidBody& body);

/// Reads the linear and angular factors of a btRigidBody, world axes.
AxisFactors axisFactors(const btRigidBody& body);

/// Reads a btRigidBody.
MotionView motionOf(const btRigidBody& body);

/// Collects gravity, applied forces and torques, and the ambient flow of a rigid body at the start
/// of a step; world axes.
Surroundings readSurroundings(const AmbientBody& ambient);

/// Sets pose, twist and rounding of a view from a pose in Bullet and a velocity in world axes.
void setMotion(const btTransform& pose, const Twist& twist_W, MotionView& view);

AMBIENT_END
