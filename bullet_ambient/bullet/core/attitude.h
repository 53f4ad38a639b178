#pragma once

#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyLink.h>

#include <cmath>
#include <limits>

#include "bullet_ambient/bullet/core/conversions.h"
#include "bullet_ambient/bullet/core/precision_check.h"

AMBIENT_BEGIN

// Bullet turns bodies by the C library's sine and cosine, whose last bits hang on the processor.
// The functions here turn them by ours, docs/conventions.md "The same bits".

/// Two attitudes that differ by no more are one but for Bullet's arithmetic [rad].
inline const double kTurnRounding =
    std::sqrt(16 * static_cast<double>(std::numeric_limits<btScalar>::epsilon()));

/// Returns the turn that Bullet makes of the vector `turn` [rad] in one step. Beyond pi/4 it turns
/// by less.
Quaternion turnOfBullet(const Vector3& turn) noexcept;

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

/// Computes anew what Bullet keeps of the position of a link's joint: its rotation and the way from
/// its parent, like btMultibodyLink::updateCacheMultiDof(). Returns true if a number has changed.
bool settleLink(btMultibodyLink& link) noexcept;

AMBIENT_END
