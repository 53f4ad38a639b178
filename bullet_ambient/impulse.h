#pragma once

// Answer of a body in a fluid to impulses, for vehicles and characters.

#include <BulletDynamics/Dynamics/btRigidBody.h>

#include "bullet_ambient/bullet/core/precision_check.h"

AMBIENT_BEGIN

class Fluid;

/// Inverse effective mass at a point, relative to the centre of mass [1/kg], symmetric: the change
/// of the point's velocity per impulse that acts there; world axes. Of the inverse K^-1 of the
/// total inertia, or K_eff^-1 of docs/theory.md eq. (30) with locked axes: what contacts and joints
/// see. Along a unit vector n it is n . M^-1 n, in place of
/// btRigidBody::computeImpulseDenominator(). A body without a fluid (not added to one, density 0,
/// static) answers as in stock Bullet.
/// @throws std::invalid_argument if setMassProps() has given a body in a fluid values that are not
/// physical.
btMatrix3x3 inverseEffectiveMass(const Fluid& fluid, const btRigidBody& body,
                                 const btVector3& relative_position);

AMBIENT_END
