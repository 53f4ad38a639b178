#pragma once

#include <string>
#include <vector>

#include "preprocess/shape/shapes.h"

namespace ambient {

/// All lengths of a shape multiplied.
PlacedShape scaled(PlacedShape part, double factor);

/// All that acts on the fluid, as bytes: equal for equal parts.
std::string contentOf(std::vector<PlacedShape> parts);

/// Checks that the largest size or place of each part is 0 or kSmallestSize to kLargestSize. That
/// sizes are positive is looked at where solids are made.
/// @throws std::runtime_error in one line that begins with the part's name.
void requireUsualNumbers(const std::vector<PlacedShape>& parts);

/// A collision shape by its form and its size.
struct ShapeForm {
  std::string kind;                ///< as Bullet names it
  std::vector<PlacedShape> parts;  ///< closed; their lengths over the size
  double size = 1;                 ///< [m]
};

/// Returns the shape with the largest of its numbers as its size. Sizes and places are rounded to
/// 20 binary digits, points to 24, those of a float, so that what scaling rounds does not make two
/// forms of one.
/// @throws std::runtime_error that begins with the part's name, if a number is not finite or all
/// are zero.
ShapeForm normalised(ShapeForm form);

}  // namespace ambient
