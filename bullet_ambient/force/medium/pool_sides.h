#pragma once

#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// Vertical planes at which the water around a body ends: sides of a pool that cut the body,
/// docs/theory.md section 17. In the frame of the fluid body F.
struct PoolSides {
  static constexpr int kMost = 4;  // a box has four vertical sides
  struct Side {
    Vector3 normal{0, 0, 0};  ///< unit, out of the pool
    Vector3 point{0, 0, 0};   ///< of the plane [m]
  };
  int count = 0;
  Side of[kMost];
};

}  // namespace ambient
