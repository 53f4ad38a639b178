#pragma once

#include <BulletCollision/CollisionShapes/btCollisionShape.h>

#include <string>
#include <vector>

#include "bullet_ambient/bullet/precision_check.h"
#include "preprocess/collision_shape/convex_solids.h"

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {

/// The solids that a collision shape consists of, in its frame, local scalings applied. With
/// `margins`, convex hulls and cones are as large as Bullet collides with them; the margins of
/// boxes and cylinders are part of their size anyhow. Triangle meshes have none. Solids share the
/// faces.
/// @throws std::runtime_error in one line that begins with `name` and says where in the shape and
/// why, for a shape that cannot be a body in a fluid.
std::vector<Solid> makeCollisionSolids(const btCollisionShape& shape, bool margins,
                                       const SolidResolution& resolution, const std::string& name);

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
