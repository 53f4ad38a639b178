#include <benchmark/benchmark.h>

#include <memory>

#include "bullet_ambient/fluid_body/packed/packed_shape.h"
#include "bullet_ambient/force/law/viscous_law.h"
#include "bullet_ambient/force/loads/face_loads.h"
#include "bullet_ambient/force/loads/surface_loads.h"
#include "preprocess/builder/fluid_body_builder.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "tests/support/bodies/geodesic.h"

namespace ambient {
namespace {

Twist someTwist() { return {{3, -2, 5}, {4, 1, -2}}; }

void reportPerFace(benchmark::State& state, std::size_t faces) {
  state.counters["per_face"] =
      benchmark::Counter(static_cast<double>(faces), benchmark::Counter::kIsIterationInvariantRate |
                                                         benchmark::Counter::kInvert);
}

void faceLoads(benchmark::State& state, bool friction) {
  const FaceTable faces = test::faceTableOf(test::geodesicSphere(static_cast<int>(state.range(0))));
  const LoadSettings settings{1.204, 1.82e-5, 0, friction};
  const double length = test::referenceLength(faces);
  Twist twist = someTwist();
  for (auto _ : state) {
    benchmark::DoNotOptimize(twist);
    benchmark::DoNotOptimize(computeFaceLoads(faces, length, twist, settings));
  }
  reportPerFace(state, faces.size());
}
BENCHMARK_CAPTURE(faceLoads, pressure, false)->DenseRange(0, 5);
BENCHMARK_CAPTURE(faceLoads, friction, true)->DenseRange(0, 5);

void singleLoads(benchmark::State& state, bool friction, PressureLaw law) {
  FaceTable faces = test::faceTableOf(test::geodesicSphere(static_cast<int>(state.range(0))));
  faces.sharpness.assign(faces.size(), 0.5);
  const PackedFaces packed =
      law == PressureLaw::kForm ? PackedFaces(faces, FormShape{}) : PackedFaces(faces);
  const LoadSettings settings{1.204, 1.82e-5, 0, friction, law};
  const double length = test::referenceLength(faces);
  Twist twist = someTwist();
  for (auto _ : state) {
    benchmark::DoNotOptimize(twist);
    benchmark::DoNotOptimize(computeFaceLoad(packed, length, twist, settings));
  }
  reportPerFace(state, faces.size());
}
BENCHMARK_CAPTURE(singleLoads, pressure, false, PressureLaw::kPublished)->DenseRange(0, 5);
BENCHMARK_CAPTURE(singleLoads, friction, true, PressureLaw::kPublished)->DenseRange(0, 5);
BENCHMARK_CAPTURE(singleLoads, form_pressure, false, PressureLaw::kForm)->DenseRange(0, 5);
BENCHMARK_CAPTURE(singleLoads, form_friction, true, PressureLaw::kForm)->DenseRange(0, 5);

/// A box of 1200 triangles, 96 points by the form law: typical of a world.
void boxLoads(benchmark::State& state, bool friction, PressureLaw law) {
  BuildSettings settings;
  settings.added_mass = Matrix6::Identity();
  const auto box =
      std::make_shared<FluidBody>(makeFluidBody(makeBoxMesh({1, 0.5, 0.25}, 1200), settings));
  FlowSettings flow;
  flow.law = law;
  flow.skin_friction = friction;
  const auto loads = makeSurfaceLoads(box, water(), flow);
  Twist twist = someTwist();
  for (auto _ : state) {
    benchmark::DoNotOptimize(twist);
    benchmark::DoNotOptimize(loads->load(twist));
  }
}
BENCHMARK_CAPTURE(boxLoads, pressure, false, PressureLaw::kPublished);
BENCHMARK_CAPTURE(boxLoads, friction, true, PressureLaw::kPublished);
BENCHMARK_CAPTURE(boxLoads, form_pressure, false, PressureLaw::kForm);
BENCHMARK_CAPTURE(boxLoads, form_friction, true, PressureLaw::kForm);

void ballLoads(benchmark::State& state) {
  Twist twist = someTwist();
  for (auto _ : state) {
    benchmark::DoNotOptimize(twist);
    benchmark::DoNotOptimize(computeBallLoad(0.5, {1.204, 1.82e-5, 0}, twist));
  }
}
BENCHMARK(ballLoads);

}  // namespace
}  // namespace ambient

BENCHMARK_MAIN();
