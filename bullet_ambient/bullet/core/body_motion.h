#pragma once

#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyLink.h>

#include <cmath>
#include <limits>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/bullet/core/conversions.h"
#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/immersed/ambient_body.h"
#include "bullet_ambient/motion/rows/row_velocity.h"

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

// Bullet turns bodies by the C library's sine and cosine, whose last bits hang on the processor.
// The functions here turn them by ours, docs/conventions.md "The same bits".

/// Two attitudes that differ by no more are one but for Bullet's arithmetic [rad].
inline const double kTurnRounding =
    std::sqrt(16 * static_cast<double>(std::numeric_limits<btScalar>::epsilon()));

/// Largest turn that Bullet makes in a step [rad], its ANGULAR_MOTION_THRESHOLD.
constexpr double kMostTurn = kPi / 4;

/// Returns the attitude that Bullet's integrateTransform() gives to a body at `from` that turns by
/// `turn_W` [rad]. Beyond pi/4 it turns by less, as Bullet does.
Quaternion turnedByBullet(const Quaternion& from, const Vector3& turn_W) noexcept;

/// Sets the attitude of a body that Bullet has brought there up to kTurnRounding. Leaves a body
/// alone that others have turned.
void settleAttitude(btRigidBody& body, const Quaternion& attitude) noexcept;

/// Returns the turn by a spin [rad/s] in the time h [s], of which btMultiBody::
/// stepPositionsMultiDof() makes at most pi/4. But for sine and cosine it has Bullet's bits.
btQuaternion turnInStep(const btVector3& spin, btScalar h) noexcept;

/// Returns btQuaternion(axis, angle [rad]).
btQuaternion turnAbout(const btVector3& axis, btScalar angle) noexcept;

/// Computes anew what Bullet keeps of the position of a link's joint: its rotation and the offset
/// from its parent, like btMultibodyLink::updateCacheMultiDof(). Returns true if a number has
/// changed.
bool settleLink(btMultibodyLink& link) noexcept;

AMBIENT_END
