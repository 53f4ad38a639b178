#pragma once

#include <BulletCollision/CollisionShapes/btCollisionShape.h>

#include <string>

#include "bullet_ambient/bullet/core/precision_check.h"

AMBIENT_BEGIN

/// Says why a shape that has no solids cannot be a body in a fluid, and what to use instead.
/// @throws std::runtime_error always, in one line that begins with `name`.
[[noreturn]] void refuseShape(const btCollisionShape& shape, const std::string& name);

AMBIENT_END
