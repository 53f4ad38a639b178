#pragma once

#include <BulletCollision/CollisionShapes/btCollisionShape.h>

#include <string>
#include <vector>

#include "bullet_ambient/bullet/precision_check.h"
#include "preprocess/collision_shape/shape_part.h"

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {

/// What a collision shape consists of, in its frame, local scalings applied; reads it once, and
/// keeps nothing of it. With `margins`, convex hulls and cones are as large as Bullet collides with
/// them; the margins of boxes and cylinders are part of their size anyhow. Triangle meshes have
/// none. Cost: that of copying its numbers.
/// @throws std::runtime_error in one line that begins with `name` and says where in the shape and
/// why, for a shape that cannot be a body in a fluid. Sizes are looked at by makeSolids().
std::vector<ShapePart> readShapeParts(const btCollisionShape& shape, bool margins,
                                      const std::string& name);

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
