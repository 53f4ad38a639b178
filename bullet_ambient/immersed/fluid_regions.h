#pragma once

#include <map>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/force/medium/fluid_region.h"
#include "bullet_ambient/immersed/region_fluids.h"
#include "bullet_ambient/immersed/region_id.h"
#include "bullet_ambient/immersed/region_index.h"

AMBIENT_BEGIN

/// The regions of one fluid. Changed between steps only; any thread may read them in a step.
class FluidRegions {
 public:
  using Entry = RegionEntry;

  bool empty() const noexcept { return entries_.empty(); }
  const std::map<RegionId, Entry>& all() const noexcept { return entries_; }
  /// The region that counts at a point, null: none. The highest priority first; of equal ones the
  /// last added. `asked`: as RegionIndex::find().
  const Entry* find(const Vector3& point_W, long long& asked) const noexcept;
  /// @throws std::invalid_argument if there is no such region.
  const FluidRegion& require(RegionId id) const;

  /// The fluids of all regions.
  RegionFluids fluids() const;
  /// Returns the fluids of a region that no region here has.
  RegionFluids missing(const FluidRegion& region) const;

  /// The number of the next region that is added.
  RegionId next() const noexcept { return static_cast<RegionId>(next_); }
  /// @pre checkRegion() has passed.
  RegionId add(FluidRegion region);
  void set(RegionId id, FluidRegion region);
  /// False if there is none.
  bool remove(RegionId id);

  double time = 0;           ///< that the world was stepped with its action [s]
  bool has_changed = false;  ///< bodies that sleep have yet to hear of it

 private:
  void insert(Entry& entry);
  void withdraw(const Entry& entry);

  std::map<RegionId, Entry> entries_;
  RegionIndex index_;
  // Number of regions that have each fluid.
  std::map<FluidKind, int> media_;
  std::map<SurfaceKind, int> surfaces_;
  int next_ = 0;
};

/// @throws std::invalid_argument as checkRegion(), beginning with the region's number.
void checkRegion(RegionId id, const FluidRegion& region);

AMBIENT_END
