#pragma once

#include <BulletDynamics/Dynamics/btRigidBody.h>

#include "bullet_ambient/bullet/precision_check.h"

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {

/// The number that Bullet gives to each btRigidBody when it is constructed. It tells a body from a
/// later one at the same address. @pre the body is alive.
int instanceNumber(const btRigidBody& body) noexcept;

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
