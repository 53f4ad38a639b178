#pragma once

#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// Waves that a floating body has made, as far as they act on it: two states each for heave and for
/// tilt about the horizontal axes; docs/theory.md eq. (69).
struct WaveMemory {
  double heave[2] = {0, 0};                    ///< [m]
  Vector3 tilt_W[2] = {{0, 0, 0}, {0, 0, 0}};  ///< horizontal [rad]
  double heave_energy = 0, tilt_energy = 0;    ///< [J]

  double energy() const { return heave_energy + tilt_energy; }
};

}  // namespace ambient
