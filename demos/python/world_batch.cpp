#include "demos/worlds/world_batch.h"

#include <pybind11/stl.h>

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "demos/python/arrays.h"
#include "demos/python/bindings.h"
#include "demos/python/python_world.h"

namespace ambient {
namespace {

namespace py = pybind11;

using Flags = py::array_t<bool, py::array::c_style>;

/// Worlds owned by Python. One thread at a time may use them.
class PythonBatch {
 public:
  PythonBatch(const Scene& scene, const BatchSettings& settings) {
    const py::gil_scoped_release others_run;
    batch_ = std::make_unique<WorldBatch>(scene, settings);
  }

  WorldBatch& get() const {
    if (is_stepping_) throw std::logic_error("the batch is in use by another thread");
    return *batch_;
  }
  /// Calls work(WorldBatch&) while other threads of Python run.
  template <class Work>
  void freely(const Work& work) {
    WorldBatch& batch = get();
    struct Stepping {
      bool& flag;
      ~Stepping() { flag = false; }
    } const in_use{is_stepping_};
    is_stepping_ = true;
    const py::gil_scoped_release others_run;
    work(batch);
  }

 private:
  std::unique_ptr<WorldBatch> batch_;
  bool is_stepping_ = false;  // guarded by the interpreter's lock
};

template <class Value>
Value take(const py::dict& from, const char* key, const Value& absent) {
  return from.contains(key) ? valueFrom<Value>(from[key], key) : absent;
}

Vector3 vectorIn(const py::dict& from, const char* key) {
  return from.contains(key) ? vectorFrom(from[key].cast<InputArray>(), key) : Vector3::Zero();
}

template <class Def>
Def fieldFrom(const py::dict& from) {
  Def def;
  def.kind = valueFrom<std::string>(from["kind"], "kind");
  def.body = take(from, "body", def.body);
  if constexpr (!std::is_same_v<Def, VariationDef>) def.rows = take(from, "rows", def.rows);
  return def;
}

std::vector<double> boundFrom(const py::dict& from, const char* key) {
  const auto bound = from[key].cast<InputArray>();
  return {bound.data(), bound.data() + bound.size()};
}

BatchSettings settingsFrom(const py::dict& from) {
  BatchSettings settings;
  settings.worlds = valueFrom<int>(from["worlds"], "worlds");
  settings.substeps = valueFrom<int>(from["substeps"], "substeps");
  settings.threads = valueFrom<int>(from["threads"], "threads");
  settings.seed = valueFrom<std::uint64_t>(from["seed"], "seed");
  settings.most_steps = valueFrom<long long>(from["most_steps"], "most_steps");
  settings.fluid_bodies = folderFrom(from["cache"]);
  for (const py::handle entry : from["actions"]) {
    const auto of = entry.cast<py::dict>();
    settings.actions.push_back(fieldFrom<ActionDef>(of));
    settings.actions.back().scale = take(of, "scale", 1.0);
  }
  for (const py::handle entry : from["observations"]) {
    const auto of = entry.cast<py::dict>();
    ObservationDef def = fieldFrom<ObservationDef>(of);
    def.place = vectorIn(of, "place");
    def.noise = take(of, "noise", 0.0);
    def.bias = take(of, "bias", 0.0);
    settings.observations.push_back(std::move(def));
  }
  for (const py::handle entry : from["variations"]) {
    const auto of = entry.cast<py::dict>();
    VariationDef def = fieldFrom<VariationDef>(of);
    def.lowest = boundFrom(of, "lowest");
    def.highest = boundFrom(of, "highest");
    def.is_logarithmic = take(of, "is_logarithmic", false);
    settings.variations.push_back(std::move(def));
  }
  if (from.contains("gust")) {
    const auto gust = from["gust"].cast<py::dict>();
    settings.gust =
        GaussMarkovGusts{vectorIn(gust, "intensity"), valueFrom<double>(gust["time"], "time")};
  }
  return settings;
}

/// Names, offsets and sizes of fields.
template <class Fields>
py::list fieldsOf(const Fields& fields) {
  py::list list;
  for (const auto& of : fields)
    list.append(py::make_tuple(of.field.name, of.field.offset, of.field.size));
  return list;
}

/// View of memory of the batch, which it keeps alive.
template <class Number>
py::array viewOf(const py::object& self, Number* data, std::vector<py::ssize_t> shape) {
  return py::array_t<Number>(std::move(shape), data, self);
}

const std::uint8_t* flagsOf(const WorldBatch& batch, const Flags& flags, const char* name) {
  if (flags.ndim() != 1 || flags.shape(0) != batch.worlds())
    throw py::value_error(std::string(name) + " has shape " + shapeText(flags) + "; must be (" +
                          std::to_string(batch.worlds()) + ",)");
  return reinterpret_cast<const std::uint8_t*>(flags.data());
}

void stepWorlds(PythonBatch& self, const std::optional<Flags>& reset) {
  const std::uint8_t* flags = reset ? flagsOf(self.get(), *reset, "reset") : nullptr;
  self.freely([&](WorldBatch& batch) { batch.step(flags); });
}

void resetWorlds(PythonBatch& self, const std::optional<Flags>& mask,
                 const std::optional<std::vector<std::uint64_t>>& seeds, bool draws) {
  const std::uint8_t* flags = mask ? flagsOf(self.get(), *mask, "mask") : nullptr;
  if (seeds && seeds->size() != static_cast<std::size_t>(self.get().worlds()))
    throw py::value_error(std::to_string(seeds->size()) + " seeds; must be one for each world, " +
                          std::to_string(self.get().worlds()));
  self.freely(
      [&](WorldBatch& batch) { batch.reset(flags, seeds ? seeds->data() : nullptr, draws); });
}

py::array runWorlds(PythonBatch& self, const InputArray& actions) {
  const BatchPlan& plan = self.get().plan();
  const py::ssize_t worlds = self.get().worlds();
  if (actions.ndim() != 3 || actions.shape(0) != worlds || actions.shape(2) != plan.action_size ||
      actions.shape(1) > (1 << 30))
    throw py::value_error("actions have shape " + shapeText(actions) + "; must be (" +
                          std::to_string(worlds) + ", steps, " + std::to_string(plan.action_size) +
                          ")");
  const int steps = static_cast<int>(actions.shape(1));
  py::array_t<double> observations({worlds, actions.shape(1), py::ssize_t{plan.observation_size}});
  double* to = observations.mutable_data();
  constexpr long long kChunk = 20000;  // steps of worlds between two looks for Ctrl-C
  const int chunk = static_cast<int>(
      std::max<long long>(1, kChunk / (worlds * static_cast<long long>(plan.settings.substeps))));
  for (int begin = 0; begin < steps; begin += chunk) {
    self.freely([&](WorldBatch& batch) {
      batch.run(actions.data(), steps, to, begin, std::min(steps, begin + chunk));
    });
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  }
  return observations;
}

void requireWorld(const WorldBatch& batch, int world) {
  if (world < 0 || world >= batch.worlds())
    throw py::index_error("there is no world " + std::to_string(world) + "; there are 0 to " +
                          std::to_string(batch.worlds() - 1));
}

std::shared_ptr<PythonWorld> worldOf(const PythonBatch& batch, int number) {
  requireWorld(batch.get(), number);
  const BatchPlan& plan = batch.get().plan();
  const BatchWorld& from = batch.get().world(number);
  if (!from.fault().empty())
    throw py::value_error("world " + std::to_string(number) + " has failed: " + from.fault());
  auto made =
      std::make_shared<PythonWorld>(plan.scene, plan.settings.fluid_bodies, false, from.flowNow());
  from.copyTo(made->simulation());
  return made;
}

void bindMemory(py::class_<PythonBatch, std::shared_ptr<PythonBatch>>& type) {
  const auto rows = [&](const char* name, double* (WorldBatch::*data)(), int BatchPlan::*size,
                        const char* text) {
    const auto view = [=](const py::object& self) {
      WorldBatch& batch = self.cast<PythonBatch&>().get();
      return viewOf(self, (batch.*data)(), {batch.worlds(), batch.plan().*size});
    };
    type.def_property_readonly(name, view, text);
  };
  rows("actions", &WorldBatch::actions, &BatchPlan::action_size,
       "Actions (N, A) of the next step(), to be written.");
  rows("parameters", &WorldBatch::parameters, &BatchPlan::parameter_size,
       "What the episodes have drawn (N, P); reset(draws=False) takes what is written there.");
  rows("observations", &WorldBatch::observations, &BatchPlan::observation_size,
       "Observations (N, O) after the last call.");
  const auto flags = [&](const char* name, std::uint8_t* (WorldBatch::*data)(), const char* text) {
    const auto view = [=](const py::object& self) {
      WorldBatch& batch = self.cast<PythonBatch&>().get();
      return readOnly(viewOf(self, reinterpret_cast<bool*>((batch.*data)()), {batch.worlds()}));
    };
    type.def_property_readonly(name, view, text);
  };
  flags("failed", &WorldBatch::failed, "Whether a world has failed (N,); fault() says why.");
  flags("truncated", &WorldBatch::truncated,
        "Whether a world has made `most_steps` env steps (N,).");
  const auto episodes = [](const py::object& self) {
    WorldBatch& batch = self.cast<PythonBatch&>().get();
    return readOnly(viewOf(self, batch.episodes(), {batch.worlds()}));
  };
  type.def_property_readonly("episodes", episodes,
                             "Episodes begun since the seed was set (N,); 1: the first.");
}

}  // namespace

// Binds the base of WorldBatch in worlds.py, which describes the whole.
void bindWorldBatch(py::module_& module) {
  py::class_<PythonBatch, std::shared_ptr<PythonBatch>> type(module, "_WorldBatch");
  type.def(py::init([](const Scene& scene, const py::dict& settings) {
    return std::make_shared<PythonBatch>(scene, settingsFrom(settings));
  }));
  bindMemory(type);
  constexpr char kFields[] = "Name, first column and number of columns of each.";
  type.def_property_readonly(
          "action_fields", [](const PythonBatch& b) { return fieldsOf(b.get().plan().actions); },
          kFields)
      .def_property_readonly(
          "parameter_fields",
          [](const PythonBatch& b) { return fieldsOf(b.get().plan().variations); }, kFields)
      .def_property_readonly(
          "observation_fields",
          [](const PythonBatch& b) { return fieldsOf(b.get().plan().observations); }, kFields)
      .def("step", &stepWorlds, py::arg("reset") = py::none(),
           "Makes one env step of all worlds; those with reset[i], (N,) bool, are reset in its "
           "place.")
      .def("_reset", &resetWorlds, py::arg("mask"), py::arg("seeds"), py::arg("draws"))
      .def("run", &runWorlds, py::arg("actions"),
           "Makes T env steps open loop, without resets. Takes actions (N, T, A), returns "
           "observations (N, T, O).")
      .def(
          "state",
          [](const PythonBatch& b, int world) {
            requireWorld(b.get(), world);
            return py::bytes(b.get().state(world));
          },
          py::arg("world"), "Returns all that changes of a world, for restore().")
      .def(
          "restore",
          [](const PythonBatch& b, int world, const py::bytes& state) {
            requireWorld(b.get(), world);
            b.get().restore(world, std::string(state));
          },
          py::arg("world"), py::arg("state"),
          "Puts a world into a state of a world of this batch, or of another one of the same "
          "scene and settings.")
      .def("world", &worldOf, py::arg("number"),
           "Returns a World in the state of a world, with its masses, commands and drawn factors; "
           "its "
           "current stays as it is now.")
      .def(
          "lines",
          [](const PythonBatch& b, int world, const std::vector<std::string>& drawing) {
            requireWorld(b.get(), world);
            return linesOf(b.get().world(world).simulation(), drawing);
          },
          py::arg("world"), py::arg("drawing") = py::tuple(), kLinesText)
      .def(
          "fault",
          [](const PythonBatch& b, int world) {
            requireWorld(b.get(), world);
            return b.get().fault(world);
          },
          py::arg("world"), "Says why a world has failed; empty: it has not.");
}

}  // namespace ambient
