#pragma once

#include "bullet_ambient/bullet/core/precision_check.h"

AMBIENT_BEGIN

class FluidRegions;

/// Marks, while it lives, that functions of these regions run on this thread: whose regions and
/// bodies must not change meanwhile.
class RegionCall {
 public:
  explicit RegionCall(const FluidRegions& regions) noexcept;
  ~RegionCall();
  RegionCall(const RegionCall&) = delete;
  RegionCall& operator=(const RegionCall&) = delete;

  /// The innermost one of these regions on this thread; null: none.
  static RegionCall* current(const FluidRegions& regions) noexcept;

  bool was_refused = false;  ///< a function has tried to change them

 private:
  const FluidRegions& regions_;
  RegionCall* outer_;
};

AMBIENT_END
