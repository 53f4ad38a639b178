#pragma once

#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// Contribution of one patch of the body's surface to the added mass, docs/theory.md eq. (60). Used
/// for bodies that the surface of the water cuts. Per unit density, in frame F.
struct AddedMassPart {
  static constexpr int kNumbers = 30;  ///< numbers per part in files
  Vector3 centre{0, 0, 0};             ///< centroid of the patch [m]
  Vector6 spread = Vector6::Zero();    ///< xx, yy, zz, xy, xz, yz: mean of r r^T about centre [m^2]
  Matrix6 inertia = Matrix6::Zero();   ///< -sym int g phi^T dA about F's origin
};

}  // namespace ambient
