#pragma once

#include <vector>

#include "bullet_ambient/bullet/precision_check.h"
#include "bullet_ambient/bullet/region_id.h"
#include "bullet_ambient/force/fluid_region.h"

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {

/// The regions of one registry. Changed between steps only; any thread may read them in a step.
class FluidRegions {
 public:
  struct Entry {
    RegionId id;
    FluidRegion region;
  };

  bool empty() const noexcept { return entries_.empty(); }
  /// The highest priority first; of equal ones the last added.
  const std::vector<Entry>& all() const noexcept { return entries_; }
  /// The region that counts at a point, null: none. Adds to `asked` how many were asked.
  const Entry* find(const Vector3& point_W, long long& asked) const noexcept;

  /// @throws std::invalid_argument as checkRegion().
  RegionId add(FluidRegion region);
  /// @throws std::invalid_argument as checkRegion(), or if there is no such region.
  void set(RegionId id, FluidRegion region);
  /// False if there is none.
  bool remove(RegionId id);

  double time = 0;           ///< that the world was stepped with its action [s]
  bool has_changed = false;  ///< bodies that sleep have yet to hear of it

 private:
  void insert(RegionId id, FluidRegion region);

  std::vector<Entry> entries_;
  int next_ = 0;
};

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
