#pragma once

#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/force/medium/fluid_region.h"
#include "bullet_ambient/immersed/region_id.h"

AMBIENT_BEGIN

/// Priority and number: of the regions that hold a point, the one of the highest rank counts.
using RegionRank = std::pair<int, int>;

/// A region of a fluid.
struct RegionEntry {
  RegionId id = RegionId::kNone;
  FluidRegion region;
  std::size_t leaf = 0;  ///< where RegionIndex has it

  RegionRank rank() const noexcept { return {region.priority, static_cast<int>(id)}; }
};

/// Finds the region that counts at a point. A forest of boxes in boxes, one binary tree for each
/// digit 1 of the number of leaves, so that an added region rebuilds as many leaves as an increment
/// carries digits. Knows regions by their addresses.
class RegionIndex {
 public:
  /// Cost: O(log^2 n) in the mean over n additions.
  void add(RegionEntry& entry);
  /// Cost: O(log n); in the mean as add(), for the leaf is left empty until half of all are.
  /// @pre the region was added and has the bounds and rank that it had then.
  void remove(const RegionEntry& entry);

  /// Null: no region holds the point. Adds to `asked` how many boxes it was compared with, those of
  /// regions and those around several. Cost: O(log n) where few regions overlap. Allocates nothing.
  const RegionEntry* find(const Vector3& point_W, long long& asked) const noexcept;

 private:
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  static constexpr RegionRank kNoRank{std::numeric_limits<int>::min(), -1};

  struct Node {
    RegionBounds box{Vector3::Constant(kInfinity), Vector3::Constant(-kInfinity)};  // closed
    RegionRank best = kNoRank;  // of the regions in it
  };
  // Leaves `first` to `first + count`, a power of two. Node i has the children 2 i and 2 i + 1; the
  // root is node 1, the leaves are nodes `count` and above.
  struct Tree {
    std::size_t first, count;
  };
  struct Found {
    const RegionEntry* entry = nullptr;
    RegionRank rank = kNoRank;
  };

  // The last tree of those over leaves 0 to `end`.
  static Tree lastTree(std::size_t end) noexcept;
  Node& node(const Tree& tree, std::size_t i) { return nodes_[2 * tree.first + i]; }
  const Node& node(const Tree& tree, std::size_t i) const { return nodes_[2 * tree.first + i]; }
  static Node leafNode(const RegionEntry* entry) noexcept;
  static Node around(const Node& a, const Node& b) noexcept;
  void build(const Tree& tree);
  void sortLeaves(std::size_t first, std::size_t count);
  void dropEmptyLeaves();
  void search(const Tree& tree, const Vector3& point_W, Found& found,
              long long& asked) const noexcept;

  std::vector<RegionEntry*> leaves_;  // null: removed
  std::vector<Node> nodes_;           // two for each leaf
  std::size_t removed_ = 0;
};

AMBIENT_END
