#pragma once

#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "bullet_ambient/force/medium/fluid_region.h"
#include "bullet_ambient/immersed/region_id.h"

namespace ambient {

/// Priority and number of a region. Among regions that hold a point, the highest rank wins.
using RegionRank = std::pair<int, int>;

/// A region with its number.
struct RegionEntry {
  RegionId id = RegionId::kNone;
  FluidRegion region;
  std::size_t leaf = 0;  ///< place in its tree of RegionIndex

  RegionRank rank() const noexcept { return {region.priority, static_cast<int>(id)}; }
};

/// Region at a point and around it.
struct RegionsAround {
  const RegionEntry* entry = nullptr;  ///< of highest rank at the point; null: none
  /// False: the bounds of a region may cross a cube around the point.
  bool is_alone = true;
};

/// Finds the region of highest rank at a point, by binary trees of bounding boxes. A region that is
/// added makes a tree of one leaf; two trees of the same size become one, so that most additions
/// build small trees only. Holds addresses of regions, which must not move.
class RegionIndex {
 public:
  /// Adds a region. Cost: O(log^2 n) on average over n additions.
  void add(RegionEntry& entry);
  /// Removes a region; its leaf stays empty until half of all leaves are. Cost: O(log n); on
  /// average that of add().
  /// @pre the region was added and has the bounds and rank that it had then.
  void remove(const RegionEntry& entry);

  /// Finds the region of highest rank that holds the point; null: none. Adds the number of tested
  /// boxes to `asked`. Cost: O(log n) where few regions overlap. Allocates nothing.
  const RegionEntry* find(const Vector3& point_W, long long& asked) const noexcept {
    return findAround(point_W, 0, asked).entry;
  }
  /// Finds that region, and whether other ones or none may be within `reach` [m] of the point along
  /// each axis of W.
  RegionsAround findAround(const Vector3& point_W, double reach, long long& asked) const noexcept;
  /// Finds the region with bounds and a surface, of highest rank, that may be within `reach` [m] of
  /// the point along each axis of W; null: none. Cost: O(log n) where few regions are near.
  const RegionEntry* findPool(const Vector3& point_W, double reach,
                              long long& asked) const noexcept;

 private:
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  static constexpr RegionRank kNoRank{std::numeric_limits<int>::min(), -1};

  struct Node {
    RegionBounds box{Vector3::Constant(kInfinity), Vector3::Constant(-kInfinity)};  // closed
    RegionRank best = kNoRank;  // of the regions in it
  };
  // A tree over 2^k regions. Node i has the children 2 i and 2 i + 1; the root is node 1, the
  // leaves are nodes count() and above.
  struct Tree {
    std::vector<RegionEntry*> leaves;  // null: removed
    std::vector<Node> nodes;

    std::size_t count() const noexcept { return leaves.size(); }
  };

  static Node leafNode(const RegionEntry* entry) noexcept;
  static Node around(const Node& a, const Node& b) noexcept;
  static Tree makeTree(std::vector<RegionEntry*> leaves);
  static void sortLeaves(RegionEntry** begin, std::size_t count);
  void dropEmptyLeaves();
  // Calls visit(entry) for regions that may meet the cube with its half edge `reach` [m] around a
  // point: in each tree those of higher rank first, and none that ranks below one for which
  // visit() has returned true.
  template <class Visit>
  void forEachNear(const Vector3& point_W, double reach, long long& asked,
                   const Visit& visit) const noexcept;

  std::vector<Tree> trees_;  // of different sizes, the largest first
  std::size_t leaf_count_ = 0, removed_ = 0;
};

}  // namespace ambient
