#pragma once

#include <string>
#include <vector>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/spatial/vector_types.h"
#include "preprocess/shape/shapes.h"

namespace ambient {

/// Returns axes of which the third is a unit vector, the others by that alone.
Matrix3 axesAlong(const Vector3& third);

/// Multiplies all lengths of a shape.
PlacedShape scaled(PlacedShape part, double factor);

/// Returns all numbers of the parts that act on the fluid, as bytes: equal for equal parts.
std::string contentOf(std::vector<PlacedShape> parts);

/// Checks that the largest size or coordinate of each part is 0, or kSmallestSize to kLargestSize.
/// makeSolids() checks that sizes are positive.
/// @throws std::runtime_error in one line that begins with the part's name.
void requireUsualNumbers(const std::vector<PlacedShape>& parts);

/// A collision shape, divided into form and size.
struct ShapeForm {
  std::string kind;                ///< as Bullet names it
  std::vector<PlacedShape> parts;  ///< closed; their lengths over the size
  double size = 1;                 ///< [m]
};

/// Divides all lengths of a shape by the largest one, which becomes its size. Rounds sizes and
/// places to 20 binary digits, and points to 24, those of a float: so the rounding of scaled shapes
/// does not make different forms.
/// @throws std::runtime_error that begins with the part's name, if a number is not finite or all
/// are zero.
ShapeForm normalised(ShapeForm form);

/// Takes a cylinder of the same volume and height for a form that is a single hull whose points are
/// two polygons of many corners around one of its axes, as importers make of cylinders. On 24
/// corners, the fewest, its added mass across is off by 0.07 %, on 32 by 0.03 % (conformal map of a
/// regular polygon). Other forms stay as they are: among others a hull stays a polyhedron, of which
/// unions are soon made. Cost O(n log n).
ShapeForm recognised(ShapeForm form);

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
