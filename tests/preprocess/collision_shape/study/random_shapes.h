#pragma once

#include <btBulletCollisionCommon.h>

#include <memory>
#include <random>
#include <vector>

#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// Owner of random shapes from one seed; lengths about 1 m.
class RandomShapes {
 public:
  explicit RandomShapes(unsigned seed) : random_(seed) {}

  /// Convex hull of 6 to 30 points in a box, without margin.
  btConvexHullShape& hull();
  /// Two to five balls, cylinders, capsules, boxes and hulls, turned about z, in a cube of 2.
  /// `on_grid`: places and half sizes are multiples of 1/4, and turns of 90 degrees, so that sides
  /// meet.
  const btCompoundShape& mixedCompound(bool on_grid);

 private:
  double uniform(double low, double high);
  double length(double low, double high, bool on_grid);
  btCollisionShape* primitive(bool on_grid);
  template <class Shape>
  Shape& keep(std::unique_ptr<Shape> shape);

  std::mt19937 random_;
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
};

}  // namespace ambient
