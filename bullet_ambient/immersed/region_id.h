#pragma once

#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// Number of a region of one Fluid: from 0, in the order of addition; never used twice.
enum class RegionId : int { kNone = -1 };

/// Place of a body among the regions at the start of its last step.
struct RegionPlace {
  RegionId region = RegionId::kNone;
  bool is_above = false;       ///< true: the body is above the region's surface
  bool is_at_surface = false;  ///< true: the surface cuts the body or is near

  friend bool operator==(const RegionPlace& a, const RegionPlace& b) {
    return a.region == b.region && a.is_above == b.is_above && a.is_at_surface == b.is_at_surface;
  }
};

/// Memory of a body's last substep: the velocity that its fluid had there, of the part without a
/// given acceleration, BareVelocity.
struct FlowMemory {
  double until = -1;  ///< Fluid::time() at the end of the substep [s]; negative: there was none
  Vector3 position{0, 0, 0};  ///< of the centre of mass at its start, in W; in a region [m]
  Vector3 velocity{0, 0, 0};  ///< of the fluid there at its end, in W [m/s]
  Vector3 change{0, 0, 0};    ///< of the fluid's velocity that AmbientBody::medium lacks [m/s]
  unsigned parts = 0;         ///< BareVelocity::parts
  RegionId region = RegionId::kNone;
  bool is_above = false;  ///< true: of the fluid above the region's surface
};

}  // namespace ambient
