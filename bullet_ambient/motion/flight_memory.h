#pragma once

#include "bullet_ambient/spatial/spatial_vectors.h"

namespace ambient {

/// What the leapfrog remembers from one step to the next. Reset it when anybody else changed the
/// velocity.
struct FlightMemory {
  Wrench load_W;  ///< last surface load, world axes
  bool has_load = false;
  double substep = 0;  ///< substep that the last step ended with [s]; 0: unknown
};

}  // namespace ambient
