#include <benchmark/benchmark.h>

#include "bullet_ambient/fluid_body/file/fluid_body_file.h"
#include "tests/bullet_ambient/fluid_body/example_body.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_files.h"

namespace ambient {
namespace {

/// Argument: subdivision level; 2 makes 320 faces, 3 makes 1280.
void readFile(benchmark::State& state) {
  const TemporaryFolder folder;
  const auto file = folder / "body.ambient";
  const FluidBody body = test::exampleBody(static_cast<int>(state.range(0)));
  writeFluidBody(body, file);
  for (auto _ : state) benchmark::DoNotOptimize(readFluidBody(file));
  state.counters["faces"] = static_cast<double>(body.faces.size());
  state.counters["bytes"] = static_cast<double>(std::filesystem::file_size(file));
}
BENCHMARK(readFile)->DenseRange(1, 5)->Unit(benchmark::kMicrosecond);

void writeFile(benchmark::State& state) {
  const TemporaryFolder folder;
  const FluidBody body = test::exampleBody(static_cast<int>(state.range(0)));
  for (auto _ : state) writeFluidBody(body, folder / "body.ambient");
}
BENCHMARK(writeFile)->DenseRange(1, 5)->Unit(benchmark::kMicrosecond);

void checkBody(benchmark::State& state) {
  const FluidBody body = test::exampleBody(static_cast<int>(state.range(0)));
  for (auto _ : state) checkFluidBody(body, "body");
}
BENCHMARK(checkBody)->DenseRange(1, 5)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace ambient

BENCHMARK_MAIN();
