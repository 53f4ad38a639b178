#include "demos/simulation/sweep.h"

#include <pybind11/stl.h>

#include <memory>

#include "demos/python/arrays.h"
#include "demos/python/bindings.h"
#include "demos/python/motion.h"
#include "demos/simulation/output/run_files.h"

namespace ambient {
namespace {

namespace py = pybind11;

/// Reports progress to a Python callable when it has changed, and checks for keyboard interrupts.
class PythonWatch {
 public:
  explicit PythonWatch(py::object progress) : progress_(std::move(progress)) {}

  bool operator()(int ended, int runs) {
    const py::gil_scoped_acquire lock;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (!progress_.is_none() && ended != told_) progress_(ended, runs);
    told_ = ended;
    return true;
  }

 private:
  py::object progress_;
  int told_ = -1;
};

/// Makes a Motion of shape (N, T, B); null without `with_motion`.
/// @throws ValueError if scenes have other output times than the first
std::unique_ptr<Motion> makeMotion(const std::vector<Scene>& scenes, bool with_motion) {
  if (!with_motion) return nullptr;
  const auto size = [](std::size_t count) { return static_cast<py::ssize_t>(count); };
  const std::vector<double> times = outputTimes(scenes[0]);
  for (std::size_t i = 1; i < scenes.size(); ++i)
    if (outputTimes(scenes[i]).size() != times.size())
      throw py::value_error("scene " + std::to_string(i) +
                            " has other output times than scene 0; without motion they may");
  auto motion = std::make_unique<Motion>(
      Motion::Shape{size(scenes.size()), size(times.size()), size(scenes[0].bodies.size())});
  motion->times = py::array_t<double>(size(times.size()), times.data());
  return motion;
}

void copyMotion(const SweepRun& run, Motion& to) {
  const std::size_t bodies = run.bodies.size(), times = run.record.motion.front().size();
  for (std::size_t body = 0; body < bodies; ++body)
    for (std::size_t i = 0; i < times; ++i)
      to.set((static_cast<std::size_t>(run.index) * times + i) * bodies + body,
             run.record.motion[body][i]);
}

/// Runs scenes and calls take(index, summary, trajectory, geometry) with the texts of the files of
/// each run that ended; without `texts` the last two are empty.
py::tuple runScenes(const std::vector<Scene>& scenes, const py::function& take,
                    const py::kwargs& more) {
  const bool with_texts = valueFrom<bool>(more["texts"], "texts");
  std::unique_ptr<Motion> motion = makeMotion(scenes, valueFrom<bool>(more["motion"], "motion"));
  PythonWatch watch(more["progress"]);
  SweepSettings settings;
  settings.threads = valueFrom<int>(more["threads"], "threads");
  settings.fluid_bodies = folderFrom(more["cache"]);
  if (valueFrom<bool>(more["report"], "report")) settings.report = printReport;
  settings.take = [&](const SweepRun& run) {
    const std::string summary = makeSummary(run.scene, run.bodies, run.record);
    std::string trajectory, geometry;
    if (with_texts) {
      trajectory = makeTrajectoryText(run.scene, run.record.motion);
      geometry = makeGeometryText(run.scene, run.bodies);
    }
    if (motion) copyMotion(run, *motion);
    const py::gil_scoped_acquire lock;
    take(run.index, summary, trajectory, geometry);
  };
  settings.watch = [&](int ended) { return watch(ended, static_cast<int>(scenes.size())); };
  SweepFailures failures;
  {
    const py::gil_scoped_release others_run;
    failures = runSweep(scenes, settings);
  }
  return py::make_tuple(std::move(motion), failures);
}

}  // namespace

// Binds a private function, which the public ones of the package call.
void bindSweep(py::module_& module) {
  module.def("_run_scenes", &runScenes, py::arg("scenes"), py::arg("take"));
}

}  // namespace ambient
