#pragma once

#include "bullet_ambient/spatial/spatial_vectors.h"

namespace ambient {

/// Memory of the leapfrog from one step to the next. Reset if other code has changed the
/// velocity.
struct FlightMemory {
  Wrench load_W;  ///< last surface load, world axes
  bool has_load = false;
  double substep = 0;  ///< substep to try first in the next step [s]; 0: unknown
};

}  // namespace ambient
