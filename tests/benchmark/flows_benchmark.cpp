#include <benchmark/benchmark.h>

#include "bullet_ambient/force/surface/hydrostatics.h"
#include "bullet_ambient/wind.h"
#include "tests/support/bodies/hull_bodies.h"

// One sample of each flow, and the buoyancy of a box in layers: docs/wind.md.
namespace ambient {
namespace {

void sampleFlow(benchmark::State& state, const FlowField& flow) {
  Vector3 point(1, 2, 3);
  double time = 4;
  for (auto _ : state) {
    time += 0.01;
    point.z() += 1e-6;
    benchmark::DoNotOptimize(flow(point, time));
  }
}
BENCHMARK_CAPTURE(sampleFlow, profile, windProfile({{9, 0, 0}}));
BENCHMARK_CAPTURE(sampleFlow, dryden, drydenGusts({}));
BENCHMARK_CAPTURE(sampleFlow, turbulence, turbulence({}));

// `levels`: 2, and the density is linear over the box; 3, and it bends there.
void pushInLayers(benchmark::State& state) {
  FluidBody box = test::boxBody({2, 1, 0.5}, 2);
  box.uniform_mass.inertia = Vector3(0.1, 0.35, 0.42).asDiagonal();
  const PackedHull hull(box);
  const Vector3 up = Vector3(0.1, 0.2, 1).normalized();
  std::vector<DensityLevel> levels{{-5, 1020}, {5, 1000}};
  if (state.range(0) == 3) levels.insert(levels.begin() + 1, {0, 1015});
  const auto water = layers(levels);
  for (auto _ : state)
    benchmark::DoNotOptimize(findExcessFluid({box, &hull, up, 0.1}, *water, 1000));
}
BENCHMARK(pushInLayers)->Arg(2)->Arg(3);

}  // namespace
}  // namespace ambient

BENCHMARK_MAIN();
