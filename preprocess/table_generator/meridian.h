#pragma once

#include <vector>

#include "preprocess/table_generator/ring_kernels.h"

namespace ambient {

/// A straight piece or an arc of the meridian of a body of revolution. From one to the next, the
/// fluid is on the left hand: from the top of the body down to its bottom.
struct MeridianPiece {
  MeridianPoint begin, end;
  /// Of an arc that bulges into the fluid: its centre; begin and end are as far from it.
  bool is_arc = false;
  MeridianPoint centre{0, 0};

  double length() const;
  MeridianPoint at(double fraction) const;
  /// Into the fluid.
  Eigen::Vector2d normalAt(double fraction) const;
};

/// Pieces from the axis (top) to the axis (bottom).
using Meridian = std::vector<MeridianPiece>;

/// z along the axis; centred at half height. As the shapes of JSON: docs/scenes.md.
Meridian cylinderMeridian(double radius, double height);
Meridian capsuleMeridian(double radius, double height);
/// All points within `rounding` of a cone with its apex at +height/2; 0: the cone itself.
Meridian coneMeridian(double radius, double height, double rounding);

}  // namespace ambient
