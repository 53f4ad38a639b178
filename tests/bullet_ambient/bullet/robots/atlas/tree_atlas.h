#pragma once

#include <array>

namespace ambient::test {

/// Surroundings of a random tree besides fluid; those at a surface have gravity.
enum class TreeSetting {
  kFree,
  kTethered,
  kInBox,
  kTetheredInBox,
  kLong,            ///< as kFree, with 100 links
  kThroughSurface,  ///< gravity, and the surface of still water; not in ideal fluid
  kBraked,          ///< the same, with motors that brake all revolute and prismatic joints
  kInLongSteps,     ///< as kThroughSurface, in steps of 1/5 to 1/40 s
};
constexpr int kTreeSettings = 8;
const char* nameOf(TreeSetting setting);

/// Fluid around the links.
enum class TreeFluid {
  kNone,   ///< a vacuum: stock Bullet
  kIdeal,  ///< random coupled added mass, 0.01 to 100 times the mass of each link
  kWater,  ///< added mass, and loads on the faces of ellipsoids
};

/// A tree of 1 to 12 links, or of 100, with all kinds of joints and a fixed or free base. Speeds
/// are 0.1 to 10 rad/s, steps 1/30 to 1/240 s. Links make no waves, whose energy would come back.
struct TreeCase {
  TreeSetting setting = TreeSetting::kFree;
  TreeFluid fluid = TreeFluid::kIdeal;
  unsigned seed = 0;  ///< determines all other values
};

struct TreeResult {
  bool is_finite = true;
  /// Rises of energy in 1 s over the initial kinetic energy. With gravity the scale includes a fall
  /// of links and displaced water by a link's length.
  double over_earlier = 0;  ///< largest rise above any earlier value
  double over_start = 0;    ///< largest rise above the initial value
};
TreeResult runTree(const TreeCase& tree_case);

/// Counts and extremes of many runs.
struct TreeTally {
  int runs = 0, not_finite = 0, rose = 0, rose_much = 0;  ///< rises above 1e-6, above 1 %
  double largest_rise = 0, over_start = 0;

  void add(const TreeResult& result);
};

/// Results of `runs` trees of each setting in each fluid: [setting][fluid].
using TreeTable = std::array<std::array<TreeTally, 3>, kTreeSettings>;
TreeTable runTrees(int runs, unsigned seed);

}  // namespace ambient::test
