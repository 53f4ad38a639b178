#pragma once

#include "bullet_ambient/bullet/precision_check.h"
#include "bullet_ambient/fluid_body/fluid_body.h"
#include "preprocess/collision_shape/collision_shape_body.h"
#include "preprocess/collision_shape/shape_part.h"

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {

/// The form of a collision shape, as it is, at size 1.
/// @throws std::runtime_error as makeFluidBody() of a collision shape, for the kind of the shape,
/// for the settings, and as requireUsualNumbers().
ShapeForm readForm(const btCollisionShape& shape, const CollisionShapeSettings& settings);

/// The fluid body of a form at size 1, in the shape's frame; what is reported tells its volumes at
/// its own size.
/// @throws std::runtime_error as makeFluidBody() of a collision shape.
FluidBody makeFormBody(const ShapeForm& form, const CollisionShapeSettings& settings);

/// Where makeFormBody() says that its result came from; the same provenance means the same result.
Provenance describeForm(const ShapeForm& form, const CollisionShapeSettings& settings);

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
