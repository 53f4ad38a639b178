#pragma once

// Impulses that feel the inertia of the fluid, for vehicles and characters.

#include <BulletDynamics/Dynamics/btRigidBody.h>

#include "bullet_ambient/bullet/core/precision_check.h"

AMBIENT_BEGIN

class Fluid;

// btRigidBody::applyImpulse() and its like divide by the dry mass. These answer with the inverse
// K^-1 of the total inertia, or K_eff^-1 of docs/theory.md eq. (30) with locked axes: what contacts
// and joints do. All vectors are in world axes, positions from the centre of mass. A body without a
// fluid (not added to one, density 0, static) answers as in stock Bullet; a body in a fluid is
// woken.
// @throws std::invalid_argument, all of them, if setMassProps() has given a body in a fluid values
// that are not physical.

/// Changes the velocity by an impulse [N s] that acts at `relative_position` [m].
void applyAmbientImpulse(Fluid& fluid, btRigidBody& body, const btVector3& impulse,
                         const btVector3& relative_position);

/// Changes the velocity by an angular impulse [N m s]. The linear velocity, too, if the added mass
/// couples them.
void applyAmbientTorqueImpulse(Fluid& fluid, btRigidBody& body, const btVector3& torque_impulse);

/// Inverse effective mass at a point [1/kg], symmetric: the change of the point's velocity per
/// impulse that acts there.
btMatrix3x3 inverseEffectiveMass(const Fluid& fluid, const btRigidBody& body,
                                 const btVector3& relative_position);

/// Inverse effective mass along a unit vector, n . M^-1 n [1/kg]; for vehicles and characters in
/// place of btRigidBody::computeImpulseDenominator().
btScalar inverseEffectiveMass(const Fluid& fluid, const btRigidBody& body,
                              const btVector3& relative_position, const btVector3& direction);

AMBIENT_END
