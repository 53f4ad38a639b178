#pragma once

#include "bullet_ambient/bullet/core/precision_check.h"

AMBIENT_BEGIN

class FluidRegions;

/// Guard object: while it exists, user functions of these regions (flow, surface) run on this
/// thread. Regions and bodies of that fluid must not change meanwhile.
class RegionCall {
 public:
  explicit RegionCall(const FluidRegions& regions) noexcept;
  ~RegionCall();
  RegionCall(const RegionCall&) = delete;
  RegionCall& operator=(const RegionCall&) = delete;

  /// Innermost RegionCall of these regions on this thread; null: none.
  static RegionCall* current(const FluidRegions& regions) noexcept;

  bool was_refused = false;  ///< true: a function has tried to change regions or bodies

 private:
  const FluidRegions& regions_;
  RegionCall* outer_;
};

AMBIENT_END
