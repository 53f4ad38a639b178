#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "demos/scene/scene.h"
#include "demos/simulation/body_preparation.h"
#include "demos/simulation/scene_run.h"

namespace ambient {

/// Finished run of a sweep.
struct SweepRun {
  int index = 0;
  const Scene& scene;
  const std::vector<PreparedBody>& bodies;
  const RunRecord& record;
};

struct SweepSettings {
  int threads = 0;                     ///< threads that run scenes; 0: all cores
  BodyFolder fluid_bodies;             ///< of bodies to reuse
  BodyMaker::Report report = nullptr;  ///< see BodyMaker
  /// Called with each run when it ends, on the thread that ran it; concurrent calls occur. A run
  /// fails if the function throws.
  std::function<void(const SweepRun&)> take = [](const SweepRun&) {};
  /// Called on the thread of runSweep(), some times a second, with the number of ended runs. If it
  /// returns false, or throws, each run stops within one step.
  std::function<bool(int ended)> watch = [](int) { return true; };
};

/// One sentence per failed run, by index of the scene.
using SweepFailures = std::map<int, std::string>;

/// Runs scenes in parallel, each on one thread. A failed run does not stop the others. Bodies of
/// one shape share a fluid body, which is solved once, on all cores. The bits of a result do not
/// depend on the number of threads or on other runs.
/// @throws RunStopped if told to stop; exceptions of `watch` are passed on.
SweepFailures runSweep(const std::vector<Scene>& scenes, const SweepSettings& settings);

}  // namespace ambient
