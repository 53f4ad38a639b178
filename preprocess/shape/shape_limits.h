#pragma once

#include "preprocess/shape/shape_description.h"

namespace ambient {

/// Checks the sizes of a shape before anything is computed of them: each extent, times `scale`,
/// must be kSmallestSize to kLargestSize, and the longest at most 1e6 times the shortest. Shapes of
/// files pass: requireUsualSize() looks at their meshes.
/// @throws std::runtime_error in one line that begins with the shape's source.
void requireUsualExtents(const ShapeDescription& shape, double scale);

}  // namespace ambient
