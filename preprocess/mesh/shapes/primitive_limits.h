#pragma once

#include <string>

namespace ambient {

/// Refuses a size that is not positive and finite.
/// @throws std::runtime_error naming the shape, the size and its value.
void requirePositiveSize(const std::string& shape, const std::string& what, double value);

/// Refuses a number of faces below the least one the shape can be made of, or above 1 000 000.
/// @throws std::runtime_error naming the shape, the number and the limit.
void requireFaces(const std::string& shape, int faces, int least);

/// Least number of triangles of makeCylinderMesh(), makeCapsuleMesh() and makeConeMesh(); larger
/// for slender shapes.
int leastCylinderFaces(double radius, double height);
int leastCapsuleFaces(double radius, double height);
int leastConeFaces(double radius, double height);

}  // namespace ambient
