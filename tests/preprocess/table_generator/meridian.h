#pragma once

#include <vector>

#include "tests/preprocess/table_generator/ring_kernels.h"

namespace ambient {

/// A straight piece or an arc of the meridian of a body of revolution. Pieces run from the top of
/// the body to its bottom; the fluid is on their left.
struct MeridianPiece {
  MeridianPoint begin, end;
  /// Centre of an arc that bulges into the fluid, equally far from begin and end.
  bool is_arc = false;
  MeridianPoint centre{0, 0};

  double length() const;
  MeridianPoint at(double fraction) const;
  /// Unit normal into the fluid.
  Eigen::Vector2d normalAt(double fraction) const;
};

/// Pieces from the axis at the top to the axis at the bottom.
using Meridian = std::vector<MeridianPiece>;

/// Meridians about z, centred at half height; sizes as in JSON shapes: docs/scenes.md.
Meridian cylinderMeridian(double radius, double height);
Meridian capsuleMeridian(double radius, double height);
/// Points within `rounding` of a cone with its apex at +height/2; 0: the cone itself.
Meridian coneMeridian(double radius, double height, double rounding);

}  // namespace ambient
