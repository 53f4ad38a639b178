#pragma once

#include <LinearMath/btVector3.h>

#include "bullet_ambient/bullet/attach_def.h"
#include "bullet_ambient/bullet/precision_check.h"

class btMultiBody;
class btMultiBodyDynamicsWorld;

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {

struct AmbientLink;
class AmbientBodies;

/// A link of a btMultiBody; -1 is its base.
struct LinkOf {
  btMultiBody& multi_body;
  int link;
};

/// Gives the stand-in the mass of its link, and the world's gravity.
void standIn(AmbientLink& link, const btMultiBody& multi_body, const btVector3& gravity) noexcept;

/// AmbientRegistry::attach() of a link. @throws std::invalid_argument as that.
void attachLink(AmbientBodies& bodies, btMultiBodyDynamicsWorld& world, const LinkOf& link,
                AttachDef def);

/// Wakes it, as btCollisionObject::activate() does with bodies.
void wake(btMultiBody& multi_body) noexcept;

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
