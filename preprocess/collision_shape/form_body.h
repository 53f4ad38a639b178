#pragma once

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "preprocess/collision_shape/collision_shape_settings.h"
#include "preprocess/collision_shape/shape_form.h"

namespace ambient {

/// Makes the fluid body of a form at size 1, in the shape's frame.
/// @throws std::runtime_error as makeFluidBody() of a collision shape.
FluidBody makeFormBody(const ShapeForm& form, const CollisionShapeSettings& settings);

/// Returns the provenance that makeFormBody() gives its result; the same provenance means the same
/// result.
Provenance describeForm(const ShapeForm& form, const CollisionShapeSettings& settings);

/// Returns true if the added mass of a form has a closed form or a table: its fluid body is made in
/// about a millisecond.
bool isSoonMade(const ShapeForm& form, const CollisionShapeSettings& settings);

/// Checks the settings. @throws std::runtime_error in one line that begins with `name`, if a value
/// is out of range
void requireUsable(const CollisionShapeSettings& settings, const std::string& name);

}  // namespace ambient
