#pragma once

#include <array>
#include <string>

namespace ambient::test {

/// What a random tree meets, besides still fluid; without gravity but in the last.
enum class TreeSetting {
  kFree,
  kTethered,
  kInBox,
  kTetheredInBox,
  kLong,            ///< nothing, but it has 100 links
  kThroughSurface,  ///< weight, and the surface of still water; not in ideal fluid
};
constexpr int kTreeSettings = 6;
const char* nameOf(TreeSetting setting);

/// What is around its links.
enum class TreeFluid {
  kNone,   ///< a vacuum: stock Bullet
  kIdeal,  ///< of an arbitrary coupled added mass, 0.01 to 100 times the mass of each link
  kWater,  ///< with the loads on the faces of ellipsoids
};

/// A tree of 1 to 12 links, or of 100, with joints of all kinds, its base fixed or free, at 0.1 to
/// 10 rad/s, steps from 1/30 to 1/240 s.
struct TreeCase {
  TreeSetting setting = TreeSetting::kFree;
  TreeFluid fluid = TreeFluid::kIdeal;
  unsigned seed = 0;  ///< of all the rest
};

struct TreeResult {
  bool is_finite = true;
  /// Of the energy in 1 s; over the kinetic energy of the start, with weight plus that of a fall of
  /// links and displaced water by a link's length.
  double over_earlier = 0;  ///< the largest rise above any earlier one
  double over_start = 0;    ///< above that of the start
};
TreeResult runTree(const TreeCase& tree_case);

/// What became of many.
struct TreeTally {
  int runs = 0, not_finite = 0, rose = 0, rose_much = 0;  ///< by more than 1e-6, by more than 1 %
  double largest_rise = 0, over_start = 0;

  void add(const TreeResult& result);
};

/// `runs` of each setting in each fluid: [setting][fluid].
using TreeTable = std::array<std::array<TreeTally, 3>, kTreeSettings>;
TreeTable runTrees(int runs, unsigned seed);

}  // namespace ambient::test
