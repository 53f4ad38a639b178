#include "demos/simulation/sweep.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <mutex>

#include "demos/simulation/output/run_files.h"
#include "tests/demos/scene/scene_text.h"
#include "tests/support/no_more_threads.h"

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

}  // namespace
}  // namespace ambient
