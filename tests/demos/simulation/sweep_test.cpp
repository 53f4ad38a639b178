#include "demos/simulation/sweep.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <mutex>
#include <numeric>
#include <string>

#include "demos/analysis/path_summary.h"
#include "demos/integrators/integrators.h"
#include "demos/simulation/output/run_files.h"
#include "tests/demos/scene/scene_text.h"
#include "tests/demos/simulation/scenes/run_scene.h"
#include "tests/support/threads.h"

namespace ambient {
namespace {

using nlohmann::json;

/// Scenes of balls with several masses; ball `bad` overflows during its flight.
std::vector<Scene> balls(int count, int bad = -1) {
  std::vector<Scene> scenes;
  for (int i = 0; i < count; ++i) {
    json scene = ballScene();
    scene["bodies"][0]["shape"]["faces"] = 80;
    scene["duration"] = 0.1;
    scene["bodies"][0]["mass"] = 0.1 * (i + 1);
    if (i == bad) scene["bodies"][0]["linear_velocity"] = {1e200, 0, 0};
    scenes.push_back(sceneFrom(scene));
  }
  return scenes;
}

struct Results {
  std::map<int, std::string> trajectories;
  SweepFailures failures;
};

Results runWith(const std::vector<Scene>& scenes, int threads) {
  Results results;
  std::mutex mutex;
  SweepSettings settings;
  settings.threads = threads;
  settings.take = [&](const SweepRun& run) {
    const std::string text = makeTrajectoryText(run.scene, run.record.motion);
    const std::lock_guard<std::mutex> lock(mutex);
    results.trajectories[run.index] = text;
  };
  results.failures = runSweep(scenes, settings);
  return results;
}

TEST(Sweep, GivesTheSameBitsOnAnyNumberOfThreads) {
  const std::vector<Scene> scenes = balls(7);
  const Results one = runWith(scenes, 1);
  EXPECT_EQ(one.trajectories.size(), 7u);
  EXPECT_NE(one.trajectories.at(0), one.trajectories.at(1));
  for (const int threads : {2, 3, 16})
    EXPECT_EQ(runWith(scenes, threads).trajectories, one.trajectories) << threads;
}

TEST(Sweep, RunsAllWhereNoThreadCanBeStarted) {
  const std::vector<Scene> scenes = balls(3);
  const Results one = runWith(scenes, 1);
  const test::NoMoreThreads none;
  const Results alone = runWith(scenes, 2);
  EXPECT_TRUE(alone.failures.empty());
  EXPECT_EQ(alone.trajectories, one.trajectories);
}

TEST(Sweep, ARunThatFailsDoesNotStopTheOthers) {
  const Results results = runWith(balls(5, 2), 2);
  ASSERT_EQ(results.failures.size(), 1u);
  EXPECT_NE(results.failures.at(2).find("body \"ball\": its state is not finite at t = 0.01 s"),
            std::string::npos);
  EXPECT_EQ(results.trajectories.size(), 4u);
  EXPECT_EQ(results.trajectories.count(2), 0u);
}

TEST(Sweep, WhatTakesARunMayRefuseIt) {
  SweepSettings settings;
  settings.take = [](const SweepRun& run) {
    if (run.index == 1) throw std::runtime_error("no place for it");
  };
  EXPECT_EQ(runSweep(balls(3), settings), (SweepFailures{{1, "no place for it"}}));
}

TEST(Sweep, TellsHowManyHaveEnded) {
  std::vector<int> told;
  SweepSettings settings;
  settings.watch = [&](int ended) {
    told.push_back(ended);
    return true;
  };
  runSweep(balls(3), settings);
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  EXPECT_EQ(told.back(), 3);
}

TEST(Sweep, StopsWithinAStepWhenTold) {
  std::vector<Scene> scenes = balls(4);
  for (Scene& scene : scenes) {
    scene.duration = 1e9;  // endless run
    scene.output_step = 1e9;
  }
  SweepSettings settings;
  settings.watch = [](int) { return false; };
  EXPECT_THROW(runSweep(scenes, settings), RunStopped);
  settings.watch = [](int) -> bool { throw std::logic_error("stop"); };
  EXPECT_THROW(runSweep(scenes, settings), std::logic_error);
}

TEST(Sweep, OfNothingIsNothing) { EXPECT_TRUE(runSweep({}, {}).empty()); }

// The falling plates of Padilla et al. 2025, section 5.1, from their mesh files: oblate spheroids
// 5:1 of 0.2 g in air, released at rest 85 degrees from horizontal. "8 cm tumbles, 9 cm mixes
// flutter and tumbling, 10 cm flutters."
// Scenes at 60 Hz that look right must give no warning of long steps. Longer steps must be
// counted.

struct PlateCase {
  std::string scene;
  FallingMode mode;
};

/// Integrator and step of the motion.
struct Stepping {
  OwnFlight integrator = nullptr;
  double time_step = 1.0 / 240;
};

class PlateModes : public testing::TestWithParam<PlateCase> {
 protected:
  // Solves the flow once per plate.
  void SetUp() override {
    scene_ = readNamedScene(GetParam().scene);
    bodies_ = prepare(scene_);
  }

  Fall fallWith(const Stepping& stepping) {
    scene_.flight.own_flight = stepping.integrator;
    scene_.time_step = stepping.time_step;
    scene_.output_step = std::max(0.01, stepping.time_step);
    const RunRecord record = runPrepared(scene_, bodies_);
    return analyseFall(record.motion[0], Vector3::UnitZ(), scene_.gravity);
  }

  Scene scene_;
  std::vector<PreparedBody> bodies_;
};

TEST_P(PlateModes, AreThoseOfThePaperWithEveryStepAndIntegrator) {
  for (const OwnFlight integrator : std::initializer_list<OwnFlight>{nullptr, flyRungeKutta})
    for (const double time_step : {0.03, 0.01, 1.0 / 240, 1.0 / 480, 1.0 / 960}) {
      const Fall fall = fallWith({integrator, time_step});
      EXPECT_EQ(fallingModeName(fall.mode), fallingModeName(GetParam().mode))
          << "integrator " << wordOf(kIntegratorNames, integrator) << ", time step " << time_step;
    }
}

INSTANTIATE_TEST_SUITE_P(Paper, PlateModes,
                         testing::Values(PlateCase{"plate_8cm", FallingMode::kTumbling},
                                         PlateCase{"plate_9cm", FallingMode::kMixed},
                                         PlateCase{"plate_10cm", FallingMode::kFlutter}),
                         [](const auto& plate) { return plate.param.scene; });

Scene sceneInSteps(const std::string& name, double step) {
  return readNamedScene(
      name, {{"time_step", std::to_string(step)}, {"duration", "2"}, {"output_step", "0.1"}});
}

RunRecord runAt60Hz(const std::string& name) { return runSharing(sceneInSteps(name, 1.0 / 60)); }

long long bodiesWithLongSteps(const RunRecord& record) {
  return std::accumulate(
      record.work.begin(), record.work.end(), 0LL,
      [](long long sum, const AmbientCounters& work) { return sum + work.too_long; });
}

TEST(LongSteps, AreNoneForFallingPlates) {
  for (const char* name : {"plate_8cm", "plate_9cm", "plate_10cm"})
    EXPECT_EQ(runAt60Hz(name).warning, "") << name;
}

TEST(LongSteps, AreNotToldWhereFewAreCoarse) {
  const RunRecord record = runAt60Hz("leaves");
  long long coarse = 0;
  for (const AmbientCounters& work : record.work) coarse += work.coarse;
  EXPECT_GT(coarse, 0);
  EXPECT_EQ(record.warning, "");
  EXPECT_EQ(bodiesWithLongSteps(record), 0);
}

TEST(LongSteps, AreToldOnceAndCountedOfEachBody) {
  Scene scene = sceneInSteps("leaves", 0.1);
  for (BodyDef& leaf : scene.bodies) leaf.attach.flow.law = PressureLaw::kPublished;
  const RunRecord record = runSharing(scene);
  EXPECT_NE(record.warning.find("the world's step is too long"), std::string::npos);
  EXPECT_GT(bodiesWithLongSteps(record), 1);
  EXPECT_LE(bodiesWithLongSteps(record), static_cast<long long>(scene.bodies.size()));
}

}  // namespace
}  // namespace ambient
