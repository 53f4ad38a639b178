#include <cstdio>
#include <cstdlib>

#include "tests/bullet_ambient/bullet/robots/atlas/tree_atlas.h"

// tree_atlas_study [RUNS [SEED]]: random trees, RUNS (100) in each setting and fluid. Exit code 1
// if a state in a fluid was not finite.
int main(int argc, char** argv) {
  using namespace ambient::test;
  const int runs = argc > 1 ? std::atoi(argv[1]) : 100;
  const unsigned seed = argc > 2 ? static_cast<unsigned>(std::atoi(argv[2])) : 1;
  constexpr const char* kFluids[] = {"a vacuum", "ideal fluid", "water"};
  const TreeTable table = runTrees(runs, seed);
  bool is_finite = true;
  std::puts(
      "| surroundings | fluid | runs | not finite | energy rose by more than 1e-6 | 1 % | most "
      "| above the start, most |");
  std::puts("|---|---|---|---|---|---|---|---|");
  for (int s = 0; s < kTreeSettings; ++s)
    for (int f = 0; f < 3; ++f) {
      const TreeTally& tally = table[s][f];
      if (tally.runs == 0) continue;
      std::printf("| %s | %s | %d | %d | %d | %d | %.2g | %.2g |\n",
                  nameOf(static_cast<TreeSetting>(s)), kFluids[f], tally.runs, tally.not_finite,
                  tally.rose, tally.rose_much, tally.largest_rise, tally.over_start);
      is_finite = is_finite && (f == 0 || tally.not_finite == 0);
    }
  return is_finite ? 0 : 1;
}
