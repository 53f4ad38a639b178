#pragma once

#include <BulletCollision/CollisionShapes/btCollisionShape.h>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "preprocess/collision_shape/collision_shape_settings.h"
#include "preprocess/collision_shape/shape_form.h"

AMBIENT_BEGIN

/// Reads the form of a collision shape as it is, at size 1, in its frame, local scalings applied;
/// keeps nothing of the shape. Convex hulls and cones are taken without their margin; that of boxes
/// and cylinders lies inside their size. Cost: copying its numbers.
/// @throws std::runtime_error in one line that begins with the name and says where in the shape and
/// why, for a shape that cannot be a body in a fluid, settings that cannot be, and as
/// requireUsualNumbers(). Whether sizes are positive makeSolids() looks at.
ShapeForm readForm(const btCollisionShape& shape, const CollisionShapeSettings& settings);

AMBIENT_END
