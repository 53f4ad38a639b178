#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "demos/scene/scene.h"
#include "demos/simulation/body_preparation.h"
#include "demos/simulation/scene_run.h"

namespace ambient {

/// One run of a sweep that has come to its end.
struct SweepRun {
  int index = 0;
  const Scene& scene;
  const std::vector<PreparedBody>& bodies;
  const RunRecord& record;
};

struct SweepSettings {
  int threads = 0;                     ///< that run scenes; 0: all cores
  std::filesystem::path fluid_bodies;  ///< folder that keeps them; empty: memory only
  /// Receives each run as it ends, on the thread that ran it: several at a time. What it throws
  /// makes the run a failed one.
  std::function<void(const SweepRun&)> take = [](const SweepRun&) {};
  /// Is told on the calling thread, some times a second, how many runs have ended. If it answers
  /// false, or throws, the sweep stops within a step of each run.
  std::function<bool(int ended)> watch = [](int) { return true; };
};

/// Sentences about the runs that failed, by index.
using SweepFailures = std::map<int, std::string>;

/// Runs scenes on threads, each on one. A run that fails does not stop the others. Bodies of one
/// shape share a fluid body, which is solved once, on all cores. What comes of a run does not
/// depend on the threads or on the other runs, bit for bit.
/// @throws RunStopped if told to stop, and what `watch` throws.
SweepFailures runSweep(const std::vector<Scene>& scenes, const SweepSettings& settings);

}  // namespace ambient
