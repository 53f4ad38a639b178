#pragma once

#include <BulletCollision/CollisionShapes/btCollisionShape.h>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/fluid_body/fluid_body.h"
#include "preprocess/collision_shape/form_body.h"

AMBIENT_BEGIN

/// Reads the form of a collision shape as it is, at size 1, in its frame, local scalings applied;
/// keeps nothing of the shape. Convex hulls and cones are taken without their margin; that of boxes
/// and cylinders lies inside their size. Cost: copying its numbers.
/// @throws std::runtime_error in one line that begins with the name and says where in the shape and
/// why, for a shape that cannot be a body in a fluid, settings that cannot be, and as
/// requireUsualNumbers(). Whether sizes are positive makeSolids() looks at.
ShapeForm readForm(const btCollisionShape& shape, const CollisionShapeSettings& settings);

/// Makes the fluid body of a collision shape. Its frame F is that of the shape: a btRigidBody with
/// this shape needs no offset. Spheres and ellipsoids have closed forms; boxes, cylinders, capsules
/// and cones tables, as far as these reach; all else is solved.
///
/// Accepts spheres, boxes, cylinders, capsules, cones, convex hulls, tetrahedra, multi-spheres,
/// btGImpactMeshShape (a closed mesh), btUniformScalingShape, and btCompoundShape of these, nested;
/// children that touch or overlap are united. Local scalings count. A margin is the distance at
/// which contacts begin and displaces nothing; that of boxes and cylinders lies inside their size.
/// Added mass is within 0.5 % of the largest entry of its block, for convex hulls within 1 %;
/// docs/preprocessor.md has the table.
/// @throws std::runtime_error in one line that begins with the name: a plane, a height field, a
/// static triangle mesh, an empty or flat shape, a size that is not positive and finite, a mesh
/// that is not closed, settings that cannot be.
FluidBody makeFluidBody(const btCollisionShape& shape, const CollisionShapeSettings& settings = {});

/// Returns the provenance that makeFluidBody() gives its result: the kind of the shape, a hash of
/// its numbers, and the settings. The same provenance means the same result. Costs next to nothing.
/// @throws std::runtime_error for shapes and settings of a kind that makeFluidBody() refuses.
Provenance describeCollisionShape(const btCollisionShape& shape,
                                  const CollisionShapeSettings& settings = {});

AMBIENT_END
