#include <cstdio>
#include <cstdlib>

#include "tests/bullet_ambient/bullet/water/water_atlas.h"

// water_atlas_study [RUNS [SEED]]: RUNS (100) random cases per setting at the surface of still
// water, then in a vacuum. Exit code 1 if a state in water was not finite.
int main(int argc, char** argv) {
  using namespace ambient::test;
  const int runs = argc > 1 ? std::atoi(argv[1]) : 100;
  const unsigned seed = argc > 2 ? static_cast<unsigned>(std::atoi(argv[2])) : 1;
  const WaterTable table = runWaters(runs, seed);
  bool is_finite = true;
  std::puts(
      "| surroundings | | runs | not finite | rose by more than 1e-3 | 1e-2 | most at 1/30 s | "
      "1/60 s | 1/240 s | 1/960 s | above the start, most |");
  std::puts("|---|---|---|---|---|---|---|---|---|---|---|");
  for (int s = 0; s < kWaterSettings; ++s)
    for (const Around around : {Around::kWater, Around::kVacuum}) {
      const bool is_water = around == Around::kWater;
      const WaterTally& tally = table[s][static_cast<int>(around)];
      std::printf("| %s | %s | %d | %d | %d | %d |", nameOf(static_cast<WaterSetting>(s)),
                  is_water ? "water" : "vacuum", tally.runs, tally.not_finite, tally.rose,
                  tally.rose_much);
      for (const double most : tally.over_earlier) std::printf(" %.2g |", most);
      std::printf(" %.2g |\n", tally.over_start);
      is_finite = is_finite && (!is_water || tally.not_finite == 0);
    }
  return is_finite ? 0 : 1;
}
