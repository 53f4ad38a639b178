#pragma once

#include <string>
#include <vector>

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

}  // namespace ambient
