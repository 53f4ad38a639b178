#include "bullet_ambient/bullet/fluid_regions.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {

namespace {

void check(RegionId id, const FluidRegion& region) {
  try {
    checkRegion(region);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument("region of fluid " + std::to_string(static_cast<int>(id)) + ": " +
                                error.what());
  }
}

}  // namespace

const FluidRegions::Entry* FluidRegions::find(const Vector3& point_W,
                                              long long& asked) const noexcept {
  for (const Entry& entry : entries_) {
    ++asked;
    if (!entry.region.bounds || entry.region.bounds->hold(point_W)) return &entry;
  }
  return nullptr;
}

RegionId FluidRegions::add(FluidRegion region) {
  const auto id = static_cast<RegionId>(next_);
  check(id, region);
  ++next_;
  insert(id, std::move(region));
  return id;
}

void FluidRegions::set(RegionId id, FluidRegion region) {
  check(id, region);
  if (!remove(id)) {
    throw std::invalid_argument("there is no region of fluid number " +
                                std::to_string(static_cast<int>(id)));
  }
  insert(id, std::move(region));
}

bool FluidRegions::remove(RegionId id) {
  const auto found = std::find_if(entries_.begin(), entries_.end(),
                                  [&](const Entry& entry) { return entry.id == id; });
  if (found == entries_.end()) return false;
  entries_.erase(found);
  has_changed = true;
  return true;
}

void FluidRegions::insert(RegionId id, FluidRegion region) {
  const auto comes_after = [&](const Entry& entry) {
    return entry.region.priority < region.priority ||
           (entry.region.priority == region.priority && entry.id < id);
  };
  const auto place = std::find_if(entries_.begin(), entries_.end(), comes_after);
  entries_.insert(place, {id, std::move(region)});
  has_changed = true;
}

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
