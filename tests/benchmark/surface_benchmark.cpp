#include <benchmark/benchmark.h>

#include "tests/support/floating_runs.h"

// Cost of a body at the surface of water, and of the body under water. Ellipsoids of 20 * 4^level
// faces; the argument is the level.

namespace ambient {
namespace {

using test::FloatingDef;
using test::FloatingRun;

FloatingDef defOf(const benchmark::State& state) {
  FloatingDef def;
  def.shape = test::floatingEllipsoid({1, 0.8, 0.6}, static_cast<int>(state.range(0)));
  def.has_loads = true;
  return def;
}

FloatingRun runOf(const benchmark::State& state) {
  FloatingRun run(defOf(state));
  run.state.orientation = Quaternion(0.9, 0.3, 0.2, 0.1).normalized();
  run.state.twist = {{0.3, -0.2, 0.5}, {0.4, 0.1, -0.2}};
  return run;
}

void hydrostatics(benchmark::State& state) {
  const PackedHull hull(defOf(state).shape);
  SurfacePlane plane{Vector3(0.3, 0.5, 0.8).normalized(), 0.1, 1000, 9.81};
  for (auto _ : state) {
    benchmark::DoNotOptimize(plane);
    benchmark::DoNotOptimize(computeWetVolume(hull, plane));
  }
}

void extent(benchmark::State& state) {
  const PackedHull hull(defOf(state).shape);
  Vector3 s = Vector3(0.3, 0.5, 0.8).normalized();
  for (auto _ : state) {
    benchmark::DoNotOptimize(s);
    benchmark::DoNotOptimize(computeExtent(hull, s));
  }
}

void wettedInertia(benchmark::State& state) {
  const FloatingRun run = runOf(state);
  Immersion at = run.immersion();
  for (auto _ : state) {
    benchmark::DoNotOptimize(at);
    benchmark::DoNotOptimize(run.model().wetted->inertia(at));
  }
}

void inertiaGradient(benchmark::State& state) {
  const FloatingRun run = runOf(state);
  Immersion at = run.immersion();
  for (auto _ : state) {
    benchmark::DoNotOptimize(at);
    benchmark::DoNotOptimize(run.model().wetted->gradient(at, run.state.twist));
  }
}

void stand(benchmark::State& state) {
  const FloatingRun run = runOf(state);
  SurfacePlane plane = run.plane_B();
  for (auto _ : state) {
    benchmark::DoNotOptimize(plane);
    benchmark::DoNotOptimize(standAtSurface(run.model(), plane));
  }
}

void wetLoads(benchmark::State& state) {
  const FloatingRun run = runOf(state);
  const PartLoads& part = run.model().loads_below;
  WetPart wet{run.immersion().plane, 0.5};
  for (auto _ : state) {
    benchmark::DoNotOptimize(wet);
    benchmark::DoNotOptimize(part.loads->wetLoad(run.state.twist, wet));
  }
}

void allLoads(benchmark::State& state) {
  const FloatingRun run = runOf(state);
  Twist twist = run.state.twist;
  for (auto _ : state) {
    benchmark::DoNotOptimize(twist);
    benchmark::DoNotOptimize(run.model().loads_below.loads->load(twist));
  }
}

// Repeats one step from a fixed state, with the caches of a step before.
void stepAtTheSurface(benchmark::State& state) {
  FloatingRun run = runOf(state);
  run.step(1 / 240.0);
  const SurfaceStand stand = standAtSurface(run.model(), run.plane_B());
  const FlightSettings settings;
  for (auto _ : state) {
    SurfaceStand now = stand;
    FlightResult body{run.state, run.memory, {}};
    WaveMemory waves = run.waves;
    SurfaceFlight flight{
        {run.model(), test::kStill, run.surroundings(), Vector3::Zero(), settings, 1 / 240.0},
        body,
        waves,
        now};
    SurfaceFlight* const flights[] = {&flight};
    flyAtSurface(flights, 1);
    benchmark::DoNotOptimize(body);
  }
  state.counters["substeps"] = run.count.substeps;
}

void stepInTheWater(benchmark::State& state) {
  FloatingRun run = runOf(state);
  const FlightTask task{run.model().below, run.surroundings(), {}, 1 / 240.0};
  const FlightResult start = fly(task, run.state, {});
  int substeps = 0;
  for (auto _ : state) {
    const FlightResult result = fly(task, start.state, start.memory);
    substeps = result.count.substeps;
    benchmark::DoNotOptimize(result);
  }
  state.counters["substeps"] = substeps;
}

BENCHMARK(hydrostatics)->DenseRange(2, 5);
BENCHMARK(extent)->DenseRange(2, 5);
BENCHMARK(wettedInertia)->DenseRange(2, 4);
BENCHMARK(inertiaGradient)->DenseRange(2, 4);
BENCHMARK(stand)->DenseRange(2, 4);
BENCHMARK(wetLoads)->DenseRange(2, 4);
BENCHMARK(allLoads)->DenseRange(2, 4);
BENCHMARK(stepAtTheSurface)->DenseRange(2, 4);
BENCHMARK(stepInTheWater)->DenseRange(2, 4);

}  // namespace
}  // namespace ambient

BENCHMARK_MAIN();
