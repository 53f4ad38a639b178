#include "bullet_ambient/immersed/fluid_regions.h"

#include <set>
#include <stdexcept>
#include <string>
#include <utility>

namespace ambient {

namespace {

// An unset fluid above is the own medium of a body, which the body knows, or air.
std::vector<FluidKind> mediaOf(const FluidRegion& region) {
  std::vector<FluidKind> media{FluidKind(region.below)};
  const FluidKind above(region.above.value_or(air()));
  if (region.surface && !(above == media.front())) media.push_back(above);
  return media;
}

std::vector<SurfaceKind> surfacesOf(const FluidRegion& region) {
  if (!region.surface) return {};
  return {SurfaceKind(region)};
}

template <class Kind>
void discount(std::map<Kind, int>& counts, const Kind& kind) {
  const auto found = counts.find(kind);
  if (--found->second == 0) counts.erase(found);
}

template <class Kind>
std::vector<Kind> without(const std::map<Kind, int>& counts, const std::vector<Kind>& kinds) {
  std::vector<Kind> missing;
  for (const Kind& kind : kinds)
    if (counts.count(kind) == 0) missing.push_back(kind);
  return missing;
}

template <class Kind>
std::vector<Kind> allOf(const std::map<Kind, int>& counts, const std::vector<Kind>& further) {
  std::set<Kind> all(further.begin(), further.end());
  for (const auto& [kind, count] : counts) all.insert(kind);
  return {all.begin(), all.end()};
}

}  // namespace

void checkRegion(RegionId id, const FluidRegion& region) {
  try {
    ambient::checkRegion(region);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument("region of fluid " + std::to_string(static_cast<int>(id)) + ": " +
                                error.what());
  }
}

const FluidRegion& FluidRegions::require(RegionId id) const {
  const auto found = entries_.find(id);
  if (found == entries_.end())
    throw std::invalid_argument("there is no region of fluid number " +
                                std::to_string(static_cast<int>(id)));
  return found->second.region;
}

RegionFluids FluidRegions::fluids(const RegionFluids& further) const {
  return {allOf(media_, further.media), allOf(surfaces_, further.surfaces)};
}

RegionFluids FluidRegions::missing(const FluidRegion& region) const {
  return {without(media_, mediaOf(region)), without(surfaces_, surfacesOf(region))};
}

RegionId FluidRegions::add(FluidRegion region) {
  const RegionId id = next();
  Entry& entry = entries_[id];
  entry.id = id;
  entry.region = std::move(region);
  insert(entry);
  ++next_;
  return id;
}

void FluidRegions::set(RegionId id, FluidRegion region) {
  Entry& entry = entries_.at(id);
  withdraw(entry);
  entry.region = std::move(region);
  insert(entry);
}

bool FluidRegions::remove(RegionId id) {
  const auto found = entries_.find(id);
  if (found == entries_.end()) return false;
  withdraw(found->second);
  entries_.erase(found);
  return true;
}

void FluidRegions::insert(Entry& entry) {
  for (const FluidKind& kind : mediaOf(entry.region)) ++media_[kind];
  for (const SurfaceKind& kind : surfacesOf(entry.region)) ++surfaces_[kind];
  index_.add(entry);
  const FluidRegion& region = entry.region;
  may_differ_ = may_differ_ || region.bounds || region.flow ||
                (region.surface && region.surface->waveNumber() > 0);
  has_changed = true;
}

void FluidRegions::withdraw(const Entry& entry) {
  index_.remove(entry);
  for (const FluidKind& kind : mediaOf(entry.region)) discount(media_, kind);
  for (const SurfaceKind& kind : surfacesOf(entry.region)) discount(surfaces_, kind);
  has_changed = true;
}

namespace {

thread_local RegionCall* innermost_call = nullptr;

}  // namespace

RegionCall::RegionCall(const FluidRegions& regions) noexcept
    : regions_(regions), outer_(innermost_call) {
  innermost_call = this;
}

RegionCall::~RegionCall() { innermost_call = outer_; }

RegionCall* RegionCall::current(const FluidRegions& regions) noexcept {
  RegionCall* call = innermost_call;
  while (call && &call->regions_ != &regions) call = call->outer_;
  return call;
}

}  // namespace ambient
