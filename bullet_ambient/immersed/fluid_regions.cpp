#include "bullet_ambient/immersed/fluid_regions.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

namespace ambient {

namespace {

RegionBounds boxOf(const FluidRegion& region) noexcept {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  return region.bounds.value_or(
      RegionBounds{Vector3::Constant(-kInfinity), Vector3::Constant(kInfinity)});
}

// Returns the place of a region along an axis: the middle of its bounds, or the end that is finite.
double middleOf(const RegionEntry* entry, int axis) noexcept {
  if (!entry || !entry->region.bounds) return 0;
  const double low = entry->region.bounds->lowest[axis], high = entry->region.bounds->highest[axis];
  if (std::isinf(low)) return std::isinf(high) ? 0 : high;
  return std::isinf(high) ? low : low / 2 + high / 2;
}

// True if a box may hold a part of the cube with its half edge `reach` around a point. False is
// certain: a point whose numbers are not finite is left to the bounds of each region.
bool mayOverlap(const RegionBounds& box, const Vector3& point, double reach) noexcept {
  for (int axis = 0; axis < 3; ++axis)
    if (point[axis] < box.lowest[axis] - reach || point[axis] > box.highest[axis] + reach)
      return false;
  return true;
}

// True if a region holds all of the cube.
bool containsAll(const FluidRegion& region, const Vector3& point_W, double reach) noexcept {
  const Vector3 half = Vector3::Constant(reach);
  return !region.bounds ||
         (region.bounds->hold(point_W - half) && region.bounds->hold(point_W + half));
}

bool contains(const FluidRegion& region, const Vector3& point_W) noexcept {
  return !region.bounds || region.bounds->hold(point_W);
}

}  // namespace

RegionIndex::Node RegionIndex::leafNode(const RegionEntry* entry) noexcept {
  return entry ? Node{boxOf(entry->region), entry->rank()} : Node{};
}

RegionIndex::Node RegionIndex::around(const Node& a, const Node& b) noexcept {
  return {{a.box.lowest.cwiseMin(b.box.lowest), a.box.highest.cwiseMax(b.box.highest)},
          std::max(a.best, b.best)};
}

void RegionIndex::add(RegionEntry& entry) {
  std::vector<RegionEntry*> leaves{&entry};
  auto joined = trees_.end();
  while (joined != trees_.begin() && std::prev(joined)->count() == leaves.size()) {
    --joined;
    leaves.insert(leaves.end(), joined->leaves.begin(), joined->leaves.end());
  }
  Tree tree = makeTree(std::move(leaves));
  trees_.erase(joined, trees_.end());
  trees_.push_back(std::move(tree));
  ++leaf_count_;
}

void RegionIndex::remove(const RegionEntry& entry) {
  const auto tree = std::find_if(trees_.begin(), trees_.end(), [&entry](const Tree& one) {
    return entry.leaf < one.count() && one.leaves[entry.leaf] == &entry;
  });
  tree->leaves[entry.leaf] = nullptr;
  std::size_t i = tree->count() + entry.leaf;
  tree->nodes[i] = {};
  while (i /= 2) tree->nodes[i] = around(tree->nodes[2 * i], tree->nodes[2 * i + 1]);
  if (2 * ++removed_ > leaf_count_) dropEmptyLeaves();
}

void RegionIndex::dropEmptyLeaves() {
  const std::vector<Tree> before = std::exchange(trees_, {});
  removed_ = leaf_count_ = 0;
  for (const Tree& tree : before)
    for (RegionEntry* entry : tree.leaves)
      if (entry) add(*entry);
}

RegionIndex::Tree RegionIndex::makeTree(std::vector<RegionEntry*> leaves) {
  const std::size_t count = leaves.size();
  sortLeaves(leaves.data(), count);
  Tree tree{std::move(leaves), std::vector<Node>(2 * count)};
  for (std::size_t i = 0; i < count; ++i) {
    RegionEntry* entry = tree.leaves[i];
    if (entry) entry->leaf = i;
    tree.nodes[count + i] = leafNode(entry);
  }
  for (std::size_t i = count; --i > 0;)
    tree.nodes[i] = around(tree.nodes[2 * i], tree.nodes[2 * i + 1]);
  return tree;
}

// Halves by places along the axis on which these are farthest apart, and each half again.
void RegionIndex::sortLeaves(RegionEntry** begin, std::size_t count) {
  if (count < 2) return;
  RegionEntry** const end = begin + count;
  int widest = 0;
  double width = -1;
  for (int axis = 0; axis < 3; ++axis) {
    double low = kInfinity, high = -kInfinity;
    std::for_each(begin, end, [&](const RegionEntry* entry) {
      low = std::min(low, middleOf(entry, axis));
      high = std::max(high, middleOf(entry, axis));
    });
    if (!(high - low > width)) continue;
    width = high - low;
    widest = axis;
  }
  std::nth_element(begin, begin + count / 2, end,
                   [widest](const RegionEntry* a, const RegionEntry* b) {
                     return middleOf(a, widest) < middleOf(b, widest);
                   });
  sortLeaves(begin, count / 2);
  sortLeaves(begin + count / 2, count / 2);
}

// The box of the higher rank first: what is found there makes most others needless.
template <class Visit>
void RegionIndex::forEachNear(const Vector3& point_W, double reach, long long& asked,
                              const Visit& visit) const noexcept {
  RegionRank highest = kNoRank;
  for (auto tree = trees_.rbegin(); tree != trees_.rend(); ++tree) {
    constexpr int kDeepest = std::numeric_limits<std::size_t>::digits + 1;
    std::size_t waiting[kDeepest] = {1};
    int count = 1;
    while (count > 0) {
      const std::size_t i = waiting[--count];
      const Node& box = tree->nodes[i];
      if (!(highest < box.best)) continue;
      ++asked;
      if (!mayOverlap(box.box, point_W, reach)) continue;
      if (i >= tree->count()) {
        if (visit(*tree->leaves[i - tree->count()])) highest = box.best;
        continue;
      }
      const bool is_second_higher = tree->nodes[2 * i].best < tree->nodes[2 * i + 1].best;
      waiting[count++] = 2 * i + (is_second_higher ? 0 : 1);
      waiting[count++] = 2 * i + (is_second_higher ? 1 : 0);
    }
  }
}

RegionsAround RegionIndex::findAround(const Vector3& point_W, double reach,
                                      long long& asked) const noexcept {
  RegionsAround around;
  forEachNear(point_W, reach, asked, [&](const RegionEntry& entry) {
    around.is_alone = around.is_alone && containsAll(entry.region, point_W, reach);
    if (!contains(entry.region, point_W)) return false;
    around.entry = &entry;
    return true;
  });
  return around;
}

const RegionEntry* RegionIndex::findPool(const Vector3& point_W, double reach,
                                         long long& asked) const noexcept {
  const RegionEntry* pool = nullptr;
  forEachNear(point_W, reach, asked, [&pool](const RegionEntry& entry) {
    if (!entry.region.bounds || !entry.region.surface) return false;
    pool = &entry;
    return true;
  });
  return pool;
}

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
std::vector<Kind> missingOf(const std::multiset<Kind>& known, const std::vector<Kind>& kinds) {
  std::vector<Kind> missing;
  for (const Kind& kind : kinds)
    if (known.find(kind) == known.end()) missing.push_back(kind);
  return missing;
}

template <class Kind>
std::vector<Kind> allOf(const std::multiset<Kind>& known, const std::vector<Kind>& further) {
  std::set<Kind> all(further.begin(), further.end());
  for (auto kind = known.begin(); kind != known.end(); kind = known.upper_bound(*kind))
    all.insert(*kind);
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
  return {missingOf(media_, mediaOf(region)), missingOf(surfaces_, surfacesOf(region))};
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
  for (const FluidKind& kind : mediaOf(entry.region)) media_.insert(kind);
  for (const SurfaceKind& kind : surfacesOf(entry.region)) surfaces_.insert(kind);
  index_.add(entry);
  const FluidRegion& region = entry.region;
  may_differ_ = may_differ_ || region.bounds || hasFlow(region) || region.layers ||
                (region.surface && region.surface->waveNumber() > 0);
  have_layers_ = have_layers_ || region.layers;
  has_changed = true;
}

void FluidRegions::withdraw(const Entry& entry) {
  index_.remove(entry);
  for (const FluidKind& kind : mediaOf(entry.region)) media_.erase(media_.find(kind));
  for (const SurfaceKind& kind : surfacesOf(entry.region)) surfaces_.erase(surfaces_.find(kind));
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
