#include <benchmark/benchmark.h>

#include "bullet_ambient/motion/links/link_flight.h"
#include "tests/support/bodies/random_trees.h"

// Flights of trees: chains of 3, 10 and 30 revolute joints with coupled added mass, no loads.
// Measured on one machine: 2.0, 5.1 and 18 us. Whole steps of stock Bullet for these chains, dry,
// without colliders: 1.7, 4.0 and 11 us.

namespace ambient {
namespace {

test::TestTree chain(const benchmark::State& state) {
  test::Arbitrary arbitrary(2);
  test::TreeShape shape;
  shape.links = static_cast<int>(state.range(0));
  shape.speed = 0.3;
  shape.added_mass = 2;
  return test::randomTree(arbitrary, shape);
}

void pose(benchmark::State& state) {
  test::TestTree test = chain(state);
  LinkDynamics dynamics(test.tree);
  for (auto _ : state) dynamics.setPose(test.pose);
}

void factor(benchmark::State& state) {
  test::TestTree test = chain(state);
  LinkDynamics dynamics(test.tree);
  dynamics.setPose(test.pose);
  for (auto _ : state) benchmark::DoNotOptimize(dynamics.factor());
}

void accelerations(benchmark::State& state) {
  test::TestTree test = chain(state);
  LinkDynamics dynamics(test.tree);
  dynamics.setPose(test.pose);
  dynamics.factor();
  Coordinates rate(dynamics.coordinates());
  for (auto _ : state) dynamics.accelerations(test.u, rate);
}

void response(benchmark::State& state) {
  test::TestTree test = chain(state);
  LinkDynamics dynamics(test.tree);
  dynamics.setPose(test.pose);
  dynamics.factor();
  Coordinates row = test.u, result(row.size());
  for (auto _ : state) dynamics.respond(row, result);
}

void flight(benchmark::State& state) {
  test::TestTree test = chain(state);
  LinkFlight flight(test.tree);
  const Coordinates u = test.u;
  for (auto _ : state) flight.fly(test.pose, u, 1.0 / 240, {});
}

void rowVelocity(benchmark::State& state) {
  test::TestTree test = chain(state);
  LinkFlight flight(test.tree);
  for (auto _ : state) flight.computeRowVelocity(test.pose, test.u, 1.0 / 240);
}

#define CHAINS Arg(3)->Arg(10)->Arg(30)
BENCHMARK(pose)->CHAINS;
BENCHMARK(factor)->CHAINS;
BENCHMARK(accelerations)->CHAINS;
BENCHMARK(response)->CHAINS;
BENCHMARK(flight)->CHAINS;
BENCHMARK(rowVelocity)->CHAINS;

}  // namespace
}  // namespace ambient

BENCHMARK_MAIN();
