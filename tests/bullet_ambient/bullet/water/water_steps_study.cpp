#include <cstdio>

#include "tests/bullet_ambient/bullet/water/water_atlas.h"

// water_steps_study: errors of motions at the surface at 1/30 to 1/240 s against 1/7680 s. With the
// library's substeps, then with one substep where it takes more.
int main() {
  using namespace ambient::test;
  std::puts("| motion | substeps | 1/30 s | 1/60 s | 1/120 s | 1/240 s | order |");
  std::puts("|---|---|---|---|---|---|---|");
  const auto print = [](WaterMotion motion, const char* substeps, const StepErrors& errors) {
    std::printf("| %s | %s |", nameOf(motion), substeps);
    for (const double deviation : errors.deviations) std::printf(" %.2g |", deviation);
    std::printf(" %.1f |\n", errors.order);
  };
  for (int m = 0; m < kWaterMotions; ++m) {
    const auto motion = static_cast<WaterMotion>(m);
    const StepErrors as_needed = measureSteps(motion, 0), single = measureSteps(motion, 1);
    print(motion, "as needed", as_needed);
    if (single.deviations != as_needed.deviations) print(motion, "1", single);
  }
  return 0;
}
