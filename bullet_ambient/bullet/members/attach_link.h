#pragma once

#include <LinearMath/btVector3.h>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/immersed/attach_def.h"

class btMultiBody;
class btMultiBodyDynamicsWorld;

AMBIENT_BEGIN

struct AmbientLink;
class AmbientBodies;

/// A link of a btMultiBody; -1 is its base.
struct LinkOf {
  btMultiBody& multi_body;
  int link;
};

/// Gives the stand-in the mass of its link, and the world's gravity.
void standIn(AmbientLink& link, const btMultiBody& multi_body, const btVector3& gravity) noexcept;

/// Fluid::add() of a link. @throws std::invalid_argument as that.
AmbientBody& attachLink(AmbientBodies& bodies, btMultiBodyDynamicsWorld& world, const LinkOf& link,
                        AttachDef def);

/// Wakes it, as btCollisionObject::activate() does with bodies.
void wake(btMultiBody& multi_body) noexcept;

AMBIENT_END
