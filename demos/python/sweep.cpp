#include "demos/sweep/sweep.h"

#include <pybind11/stl.h>

#include <memory>

#include "demos/python/arrays.h"
#include "demos/python/bindings.h"
#include "demos/python/motion.h"
#include "demos/simulation/summary.h"
#include "demos/sweep/case_runs.h"
#include "demos/sweep/case_table.h"

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

/// Throws unless the results of all scenes fit into one array.
void requireOneShape(const std::vector<Scene>& scenes, bool with_motion) {
  if (scenes.empty()) throw py::value_error("there are no scenes");
  const std::size_t bodies = scenes[0].bodies.size();
  const std::size_t times = outputTimes(scenes[0]).size();
  for (std::size_t i = 1; i < scenes.size(); ++i) {
    if (scenes[i].bodies.size() != bodies)
      throw py::value_error("scene " + std::to_string(i) + " has " +
                            std::to_string(scenes[i].bodies.size()) + " bodies, scene 0 has " +
                            std::to_string(bodies));
    if (with_motion && outputTimes(scenes[i]).size() != times)
      throw py::value_error("scene " + std::to_string(i) +
                            " has other output times than scene 0; without motion they may");
  }
}

/// Makes a Motion of shape (N, T, B); null without `with_motion`.
std::unique_ptr<Motion> makeMotion(const std::vector<Scene>& scenes, bool with_motion) {
  if (!with_motion) return nullptr;
  const auto size = [](std::size_t count) { return static_cast<py::ssize_t>(count); };
  const std::vector<double> times = outputTimes(scenes[0]);
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

py::tuple rollout(const std::vector<Scene>& scenes, int threads, bool with_motion,
                  const py::object& cache, const py::object& progress) {
  requireOneShape(scenes, with_motion);
  std::unique_ptr<Motion> motion = makeMotion(scenes, with_motion);
  std::vector<std::vector<TableRow>> rows(scenes.size());
  PythonWatch watch(progress);
  SweepSettings settings;
  settings.threads = threads;
  settings.fluid_bodies = folderFrom(cache);
  settings.report = printReport;
  settings.take = [&](const SweepRun& run) {
    rows[static_cast<std::size_t>(run.index)] =
        resultRows(makeSummary(run.scene, run.bodies, run.record));
    if (motion) copyMotion(run, *motion);
  };
  settings.watch = [&](int ended) { return watch(ended, static_cast<int>(scenes.size())); };
  SweepFailures failures;
  {
    const py::gil_scoped_release others_run;
    failures = runSweep(scenes, settings);
  }
  return py::make_tuple(std::move(motion), resultColumns(), rows, failures);
}

py::tuple runAll(const py::object& cases, const py::object& out, std::pair<int, int> shard,
                 const py::kwargs& more) {
  CaseSettings settings;
  settings.cases = pathFrom(cases);
  settings.out = pathFrom(out);
  requireReadable(settings.cases);
  settings.shard = Shard::parse(std::to_string(shard.first) + "/" + std::to_string(shard.second));
  settings.threads = more["threads"].cast<int>();
  settings.keep_motion = more["motion"].cast<bool>();
  PythonWatch watch(more["progress"]);
  settings.watch = [&](int ended, int runs) { return watch(ended, runs); };
  CaseCounts counts;
  {
    const py::gil_scoped_release others_run;
    counts = runCases(settings);
  }
  return py::make_tuple(counts.cases, counts.done_before, counts.failures);
}

py::tuple collect(const py::object& cases, const py::object& out) {
  requireReadable(pathFrom(cases));
  const ResultTable table = collectCases(pathFrom(cases), pathFrom(out));
  return py::make_tuple(table.columns, table.rows);
}

}  // namespace

// Binds private functions, which the public ones in bullet_ambient/sweeps.py call.
void bindSweep(py::module_& module) {
  module.def("_rollout", &rollout, py::arg("scenes"), py::arg("threads"), py::arg("motion"),
             py::arg("cache"), py::arg("progress"));
  module.def("_run_cases", &runAll, py::arg("cases"), py::arg("out"), py::arg("shard"));
  module.def("_collect", &collect, py::arg("cases"), py::arg("out"));
}

}  // namespace ambient
