#pragma once

#include <string>
#include <vector>

#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// What a closed part of a collision shape is, and which numbers it has.
enum class PartKind {
  kBall,      ///< sizes: radius
  kBox,       ///< sizes: three half sizes
  kCylinder,  ///< about z; sizes: radius, full height
  kCapsule,   ///< about z; sizes: radius, height of the cylindrical part
  kCone,      ///< about z, apex at +height/2; sizes: radius, full height; margin
  kBallHull,  ///< convex hull of ellipsoids; points: centres; sizes: three semi-axes of each
  kHull,      ///< convex hull; points; margin
  kMesh,      ///< closed surface; points: three corners of each triangle, counter-clockwise
};

/// A part of a collision shape in plain numbers, all in metres.
struct ShapePart {
  PartKind kind = PartKind::kBall;
  std::vector<double> sizes;
  std::vector<Eigen::Vector3d> points;
  double margin = 0;                       ///< all points within that distance belong to it
  Matrix3 rotation = Matrix3::Identity();  ///< from the part's axes to the shape's
  Vector3 translation = Vector3::Zero();   ///< of its origin
  std::string name;                        ///< begins messages: "crane: child 1: child 0"
  std::string part;  ///< in its compound: "child 1: child 0 (Box)"; empty: a shape of its own
};

/// The same shape, all lengths multiplied.
std::vector<ShapePart> scaled(std::vector<ShapePart> parts, double factor);

/// All that acts on the fluid, as bytes: equal for equal shapes.
std::string contentOf(const std::vector<ShapePart>& parts);

/// Checks that the largest size or place of each part is 0 or kSmallestSize to kLargestSize. That
/// sizes are positive is looked at where solids are made.
/// @throws std::runtime_error in one line that begins with the part's name.
void requireUsualNumbers(const std::vector<ShapePart>& parts);

/// A shape by its form and its size.
struct ShapeForm {
  std::string kind;              ///< as Bullet names it
  std::vector<ShapePart> parts;  ///< their lengths over the size
  double size = 1;               ///< [m]
};

/// The same shape with the largest of its numbers as its size. Sizes and places are rounded to 20
/// binary digits, points to 24, those of a float, so that what scaling rounds does not make two
/// forms of one.
/// @throws std::runtime_error that begins with the part's name, if a number is not finite or all
/// are zero.
ShapeForm normalised(ShapeForm form);

}  // namespace ambient
