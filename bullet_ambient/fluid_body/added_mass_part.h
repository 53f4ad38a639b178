#pragma once

#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// What a patch of the surface contributes to the added mass, docs/theory.md eq. (60): for bodies
/// that the surface of the water cuts. Per unit density, in frame F.
struct AddedMassPart {
  static constexpr int kNumbers = 30;
  Vector3 centre{0, 0, 0};            ///< of its area [m]
  Vector6 spread = Vector6::Zero();   ///< xx, yy, zz, xy, xz, yz: mean squares about it [m^2]
  Matrix6 inertia = Matrix6::Zero();  ///< -sym int g phi^T dA about F's origin, as added_mass
};

}  // namespace ambient
