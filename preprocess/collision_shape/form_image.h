#pragma once

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "preprocess/collision_shape/shape_form.h"

namespace ambient {

/// An image of a form across planes x = 0, y = 0, z = 0.
struct FormImage {
  ShapeForm form;
  int turned = 0;  ///< bits of the axes whose coordinates the image has with the other sign
};

/// Returns that of the eight images of a form whose numbers come first: forms that are images of
/// each other, as the limbs of a robot, have it in common. Its points are sorted, and its simple
/// shapes lie in poses that hang on nothing but their surface, rounded to 24 binary digits. Forms
/// of ellipsoids and of triangles stay as they are. Cost O(n log n).
/// @pre the form is normalised()
FormImage firstImage(const ShapeForm& form);

/// Returns the image of a body, exact to the last bit: numbers change their signs, triangles their
/// sense. The planes are appended to provenance.settings.
/// @pre the body has no holds, wings, measured drag or waterline table
FluidBody imageOf(const FluidBody& body, int turned);

}  // namespace ambient
