#pragma once

#include <map>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/force/medium/fluid_region.h"
#include "bullet_ambient/immersed/region_fluids.h"
#include "bullet_ambient/immersed/region_id.h"
#include "bullet_ambient/immersed/region_index.h"

AMBIENT_BEGIN

/// All regions of one Fluid. Changed between steps only; in a step any thread may read them.
class FluidRegions {
 public:
  using Entry = RegionEntry;

  bool empty() const noexcept { return entries_.empty(); }
  const std::map<RegionId, Entry>& all() const noexcept { return entries_; }
  /// Finds the region that holds a point: the one of highest priority, of equal ones the last
  /// added; null: none. Adds the number of tests to `asked`, see RegionIndex::find().
  const Entry* find(const Vector3& point_W, long long& asked) const noexcept;
  /// Finds that region, and whether another one or none may be within `reach` [m] of the point.
  RegionsAround findAround(const Vector3& point_W, double reach, long long& asked) const noexcept;
  /// Finds the region with bounds and a surface, of highest rank, that may be within `reach` [m] of
  /// the point; null: none.
  const Entry* findPool(const Vector3& point_W, double reach, long long& asked) const noexcept {
    return index_.findPool(point_W, reach, asked);
  }
  /// @throws std::invalid_argument if there is no such region.
  const FluidRegion& require(RegionId id) const;

  /// Returns the fluids of all regions and further ones, each once.
  RegionFluids fluids(const RegionFluids& further = {}) const;
  /// Returns those fluids of `region` that no region of this object has.
  RegionFluids missing(const FluidRegion& region) const;

  /// Number that the next add() will give.
  RegionId next() const noexcept { return static_cast<RegionId>(next_); }
  /// @pre checkRegion() has passed.
  RegionId add(FluidRegion region);
  void set(RegionId id, FluidRegion region);
  /// Removes a region. Returns false if there is none of that number.
  bool remove(RegionId id);

  /// True if a region has had bounds, a flow or waves, which may make the fluid differ along a
  /// body.
  bool mayDiffer() const noexcept { return may_differ_; }

  double time = 0;           ///< sum of all steps of the world so far [s]
  bool has_changed = false;  ///< true: regions have changed, and sleeping bodies were not woken yet

 private:
  void insert(Entry& entry);
  void withdraw(const Entry& entry);

  std::map<RegionId, Entry> entries_;
  RegionIndex index_;
  // Number of regions that have each fluid.
  std::map<FluidKind, int> media_;
  std::map<SurfaceKind, int> surfaces_;
  int next_ = 0;
  bool may_differ_ = false;
};

/// @throws std::invalid_argument as checkRegion(), beginning with the region's number.
void checkRegion(RegionId id, const FluidRegion& region);

AMBIENT_END
