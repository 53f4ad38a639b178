#include "preprocess/mesh/shapes/primitive_limits.h"

#include <cmath>

#include "preprocess/mesh/input_error.h"

namespace ambient {

namespace {
constexpr int kMostFaces = 1000000;
}

void requirePositiveSize(const std::string& shape, const std::string& what, double value) {
  if (std::isfinite(value) && value > 0) return;
  raiseInputError(shape, what, " = ", value, " m is not positive and finite");
}

void requireFaces(const std::string& shape, int faces, int least) {
  if (faces < least)
    raiseInputError(shape, "faces = ", faces, " is below the least possible number ", least);
  if (faces > kMostFaces)
    raiseInputError(shape, "faces = ", faces, " is above the largest number ", kMostFaces);
}

}  // namespace ambient
