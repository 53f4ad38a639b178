#pragma once

#include <LinearMath/btVector3.h>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/immersed/attach_def.h"

class btMultiBody;
class btMultiBodyDynamicsWorld;

AMBIENT_BEGIN

struct AmbientBody;
struct AmbientLink;
class AmbientBodies;

/// A link of a btMultiBody by Bullet's number; -1: the base.
struct LinkOf {
  btMultiBody& multi_body;
  int link;
};

/// Gives the stand-in body of a link the mass of the link and the gravity of the world.
void standIn(AmbientLink& link, const btMultiBody& multi_body, const btVector3& gravity) noexcept;

/// True if the link's mass properties have been changed since standIn().
bool isReloaded(const AmbientLink& link, const btMultiBody& multi_body) noexcept;

/// Implements Fluid::add() for a link, except the warning about light links. @throws
/// std::invalid_argument as Fluid::add()
AmbientBody& attachLink(AmbientBodies& bodies, btMultiBodyDynamicsWorld& world, const LinkOf& link,
                        AttachDef def);

/// Wakes a multibody and its colliders, like btCollisionObject::activate() for bodies.
void wake(btMultiBody& multi_body) noexcept;

AMBIENT_END
