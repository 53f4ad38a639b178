#pragma once

#include "bullet_ambient/bullet/core/precision_check.h"

AMBIENT_BEGIN

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

AMBIENT_END
