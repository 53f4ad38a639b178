#include "preprocess/collision_shape/collision_shape_body.h"

#include "preprocess/collision_shape/form_body.h"
#include "preprocess/collision_shape/shape_parts.h"

AMBIENT_BEGIN

FluidBody makeFluidBody(const btCollisionShape& shape, const CollisionShapeSettings& settings) {
  return makeFormBody(readForm(shape, settings), settings);
}

Provenance describeCollisionShape(const btCollisionShape& shape,
                                  const CollisionShapeSettings& settings) {
  return describeForm(readForm(shape, settings), settings);
}

AMBIENT_END
