#include "bullet_ambient/immersed/region_index.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "tests/bullet_ambient/bullet/regions/region_world.h"
#include "tests/support/bodies/random_bodies.h"

namespace ambient::test {
namespace {

// Regions added and removed, with the documented rule: highest priority first; of equal priority,
// the last one added.
class ArbitraryRegions {
 public:
  void add(int id, const std::optional<RegionBounds>& bounds, int priority) {
    RegionEntry& entry = entries_[id];
    entry.id = static_cast<RegionId>(id);
    entry.region.bounds = bounds;
    entry.region.priority = priority;
    index_.add(entry);
  }
  void remove(int id) {
    index_.remove(entries_.at(id));
    entries_.erase(id);
  }
  bool has(int id) const { return entries_.count(id) > 0; }

  const RegionEntry* find(const Vector3& point, long long& asked) const {
    return index_.find(point, asked);
  }
  const RegionEntry* findOneByOne(const Vector3& point) const {
    const RegionEntry* best = nullptr;
    for (const auto& [id, entry] : entries_)
      if ((!entry.region.bounds || entry.region.bounds->hold(point)) &&
          (!best || best->rank() < entry.rank()))
        best = &entry;
    return best;
  }

 private:
  std::map<int, RegionEntry> entries_;
  RegionIndex index_;
};

// Whole numbers put points on bounds, and bounds on each other; some bounds are infinite.
RegionBounds arbitraryBounds(Arbitrary& arbitrary) {
  RegionBounds bounds;
  for (int axis = 0; axis < 3; ++axis) {
    const double kind = arbitrary.between(0, 10);
    bounds.lowest[axis] = std::floor(arbitrary.between(-10, 10));
    bounds.highest[axis] = bounds.lowest[axis] + std::floor(arbitrary.between(1, 8));
    if (kind < 2) bounds.lowest[axis] = -kFar;
    if (kind > 1 && kind < 3) bounds.highest[axis] = kFar;
  }
  return bounds;
}

Vector3 arbitraryPoint(Arbitrary& arbitrary) {
  Vector3 point;
  for (int axis = 0; axis < 3; ++axis) point[axis] = std::floor(arbitrary.between(-14, 14));
  const double kind = arbitrary.between(0, 40);
  if (kind < 1) point[0] = kNotANumber;
  if (kind > 39) point[1] = kFar;
  return point;
}

TEST(RegionIndex, FindsWhatOneByOneIsFound) {
  Arbitrary arbitrary(3);
  ArbitraryRegions regions;
  int found = 0;
  long long asked = 0;
  for (int id = 0; id < 400; ++id) {
    const bool is_bounded = arbitrary.between(0, 30) > 1;
    const int priority = static_cast<int>(arbitrary.between(-2, 3));
    regions.add(id,
                is_bounded ? std::optional<RegionBounds>(arbitraryBounds(arbitrary)) : std::nullopt,
                is_bounded ? priority : -5);
    const int other = static_cast<int>(arbitrary.between(0, 1.4 * id));
    if (regions.has(other) && other != id) regions.remove(other);
    for (int i = 0; i < 40; ++i) {
      const Vector3 point = arbitraryPoint(arbitrary);
      const RegionEntry* expected = regions.findOneByOne(point);
      ASSERT_EQ(regions.find(point, asked), expected) << id << ": " << point.transpose();
      found += expected ? 1 : 0;
    }
  }
  EXPECT_GT(found, 8000);
  for (int id = 0; id < 400; ++id)
    if (regions.has(id)) regions.remove(id);
  EXPECT_EQ(regions.find({0, 0, 0}, asked), nullptr);
}

TEST(RegionIndex, ARegionThatMovesOverAndOverIsFoundWhereItIs) {
  ArbitraryRegions regions;
  for (int id = 0; id < 9; ++id)
    regions.add(id, RegionBounds{{0, 0, 1.0 * id}, {1, 1, id + 1.0}}, 0);
  long long asked = 0;
  for (int i = 0; i < 500; ++i) {
    const double x = 2 + i % 7;
    regions.remove(4);
    regions.add(4, RegionBounds{{x, 0, 0}, {x + 1, 1, 1}}, 1);
    ASSERT_EQ(regions.find({x, 0.5, 0.5}, asked), regions.findOneByOne({x, 0.5, 0.5}));
    ASSERT_EQ(regions.find({0.5, 0.5, 4.5}, asked), nullptr);
    ASSERT_EQ(regions.find({0.5, 0.5, 8.5}, asked), regions.findOneByOne({0.5, 0.5, 8.5}));
  }
  EXPECT_LT(asked, 500 * 3 * 40);  // leaves of removed regions are dropped
}

// Mean number of boxes compared with a point.
double meanAsked(int count, RegionBounds (*place)(int)) {
  ArbitraryRegions regions;
  for (int id = 0; id < count; ++id) regions.add(id, place(id), 0);
  long long asked = 0;
  const int step = std::max(1, count / 1000);
  int points = 0;
  for (int id = 0; id < count; id += step, ++points) {
    const RegionBounds box = place(id);
    Vector3 point;
    for (int axis = 0; axis < 3; ++axis)
      point[axis] =
          std::isfinite(box.highest[axis])
              ? (std::isfinite(box.lowest[axis]) ? box.lowest[axis] / 2 + box.highest[axis] / 2
                                                 : box.highest[axis] - 0.5)
              : (std::isfinite(box.lowest[axis]) ? box.lowest[axis] + 0.5 : 0);
    EXPECT_NE(regions.find(point, asked), nullptr);
  }
  return static_cast<double>(asked) / points;
}

RegionBounds inAGrid(int id) {
  const Vector3 corner(id % 22, id / 22 % 22, id / 484);
  return {corner, corner + Vector3::Ones()};
}
RegionBounds inALayer(int id) { return {{-kFar, -kFar, 1.0 * id}, {kFar, kFar, id + 1.0}}; }
RegionBounds inAShell(int id) {
  return {Vector3::Constant(-id - 1.0), Vector3::Constant(id + 1.0)};
}
RegionBounds beyond(int id) { return {{1.0 * id, -kFar, -kFar}, Vector3::Constant(kFar)}; }

// Ten regions in a list would cost up to ten comparisons.
TEST(RegionIndex, TenThousandRegionsCostSomeComparisons) {
  EXPECT_LT(meanAsked(10000, inAGrid), 60);
  EXPECT_LT(meanAsked(10000, inALayer), 60);
  EXPECT_LT(meanAsked(10000, inAShell), 60);
  EXPECT_LT(meanAsked(10000, beyond), 60);
}

}  // namespace
}  // namespace ambient::test
