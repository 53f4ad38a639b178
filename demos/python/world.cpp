#include <pybind11/stl.h>

#include <cmath>
#include <memory>
#include <optional>
#include <string>

#include "demos/python/arrays.h"
#include "demos/python/bindings.h"
#include "demos/python/motion.h"
#include "demos/simulation/motion_recorder.h"
#include "demos/simulation/scene_run.h"
#include "demos/simulation/simulation.h"

namespace ambient {
namespace {

namespace py = pybind11;

/// A simulation that Python holds: for one thread at a time, until it is closed.
class PythonWorld {
 public:
  PythonWorld(const Scene& scene, const std::filesystem::path& cache) : scene_(scene) {
    const py::gil_scoped_release others_run;
    SceneBodyCache fluid_bodies(cache, scene.threads);
    const std::vector<PreparedBody> bodies = prepareBodies(scene, fluid_bodies);
    if (!cache.empty()) fluid_bodies.save();
    simulation_ = std::make_unique<Simulation>(scene, bodies);
  }

  const Scene& scene() const { return scene_; }
  Simulation& simulation() const {
    if (!simulation_) throw py::value_error("the world is closed");
    if (is_stepping_) throw std::logic_error("the world is in use by another thread");
    return *simulation_;
  }
  MotionSample sample(std::size_t body) const { return simulation().sample()[body]; }
  void close() { simulation_.reset(); }

  /// Steps, and hands the samples after each to `take`. The interpreter is free meanwhile, and
  /// interrupts of the keyboard are heard every some steps.
  template <class Take>
  void step(long long steps, const Take& take) {
    constexpr long long kChunk = 100;
    Simulation& stepped = simulation();
    const Stepping in_use(is_stepping_);
    for (long long done = 0; done < steps;) {
      const long long end = std::min(steps, done + kChunk);
      stepFreely(stepped, end - done, take);
      done = end;
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    }
  }

 private:
  struct Stepping {
    explicit Stepping(bool& flag) : flag_(flag) { flag_ = true; }
    ~Stepping() { flag_ = false; }
    bool& flag_;
  };

  template <class Take>
  static void stepFreely(Simulation& stepped, long long steps, const Take& take) {
    try {
      const py::gil_scoped_release others_run;
      for (long long i = 0; i < steps; ++i) {
        stepped.step();
        take(stepped);
      }
    } catch (const std::runtime_error& error) {
      PyErr_SetString(PyExc_FloatingPointError, error.what());
      throw py::error_already_set();
    }
  }

  Scene scene_;
  std::unique_ptr<Simulation> simulation_;
  bool is_stepping_ = false;  // read and written with the interpreter's lock
};

/// One body of a world, which it keeps alive.
struct PythonBody {
  std::shared_ptr<PythonWorld> world;
  std::size_t index = 0;

  MotionSample sample() const { return world->sample(index); }
};

Motion motionNow(const PythonWorld& world) {
  const std::vector<MotionSample> samples = world.simulation().sample();
  Motion motion({static_cast<py::ssize_t>(samples.size())});
  for (std::size_t i = 0; i < samples.size(); ++i) motion.set(i, samples[i]);
  return motion;
}

Motion run(PythonWorld& world, double duration, std::optional<double> output_step) {
  const double step = output_step.value_or(world.scene().output_step);
  if (!(duration > 0) || !std::isfinite(duration) || !(step >= world.scene().time_step))
    throw py::value_error("duration must be above 0 and output_step at least the time step, " +
                          std::to_string(world.scene().time_step) + " s");
  Simulation& simulation = world.simulation();
  MotionRecorder recorder(timesOf(simulation.time(), duration, step), world.scene().time_step);
  recorder.add(simulation.sample());
  world.step(countSteps(duration, world.scene().time_step),
             [&](const Simulation& now) { recorder.add(now.sample()); });
  return motionOf(recorder.motion());
}

py::dict bodiesOf(const std::shared_ptr<PythonWorld>& world) {
  py::dict bodies;
  std::size_t index = 0;
  for (const BodyDef& body : world->scene().bodies)
    bodies[py::str(body.name)] = PythonBody{world, index++};
  return bodies;
}

void applyForce(const PythonBody& body, const InputArray& force, const py::object& at) {
  const Vector3 point =
      at.is_none() ? body.sample().position : vectorFrom(at.cast<InputArray>(), "at");
  body.world->simulation().applyForce(body.index, vectorFrom(force, "force"), point);
}

py::dict workOf(const PythonBody& body) {
  const FlightWork work = body.world->simulation().work(body.index);
  py::dict counts;
  counts["substeps"] = work.substeps;
  counts["load_evaluations"] = work.load_evaluations;
  counts["guarded"] = work.guarded;
  counts["coarse"] = work.coarse;
  counts["too_long"] = work.too_long;
  counts["halted"] = work.halted;
  counts["energy_removed"] = work.energy_removed;
  return counts;
}

void bindBody(py::module_& module) {
  py::class_<PythonBody>(module, "Body", "One body of a world, as it is now; world axes.")
      .def_property_readonly(
          "position", [](const PythonBody& b) { return arrayOf(b.sample().position); },
          "(3,), of the centre of mass [m]")
      .def_property_readonly(
          "orientation",
          [](const PythonBody& b) {
            const Quaternion q = b.sample().orientation;
            return arrayOf(Eigen::Vector4d(q.w(), q.x(), q.y(), q.z()));
          },
          "(4,), unit quaternion w, x, y, z that turns the shape's axes to the world's")
      .def_property_readonly(
          "twist", [](const PythonBody& b) { return arrayOf(b.sample().twist.vector()); },
          "(6,), angular [rad/s], then linear velocity [m/s]")
      .def_property_readonly(
          "work", &workOf,
          "What the fluid has cost so far, as counts, and the energy that bounds removed [J].")
      .def("apply_force", &applyForce, py::arg("force"), py::arg("at") = py::none(),
           "Adds a force (3,) [N] at a point (3,) [m], default the centre of mass, for one step.")
      .def(
          "apply_torque",
          [](const PythonBody& b, const InputArray& torque) {
            b.world->simulation().applyTorque(b.index, vectorFrom(torque, "torque"));
          },
          py::arg("torque"), "Adds a torque (3,) [N m] for one step.")
      .def(
          "set_medium",
          [](const PythonBody& b, const Medium& medium) {
            b.world->simulation().setMedium(b.index, medium);
          },
          py::arg("medium"),
          "Changes the fluid around it, outside of the scene's water and regions; its velocity "
          "stays.");
}

void bindWorldMotion(py::class_<PythonWorld, std::shared_ptr<PythonWorld>>& type) {
  type.def_property_readonly(
          "position", [](const PythonWorld& w) { return motionNow(w).position; },
          "(B, 3), of the centres of mass in world axes [m]")
      .def_property_readonly(
          "orientation", [](const PythonWorld& w) { return motionNow(w).orientation; },
          "(B, 4), unit quaternions w, x, y, z that turn the shapes' axes to the world's")
      .def_property_readonly(
          "orientation_xyzw",
          [](const PythonWorld& w) { return scalarLast(motionNow(w).orientation); },
          "(B, 4), as SciPy and PyBullet order them")
      .def_property_readonly(
          "twist", [](const PythonWorld& w) { return motionNow(w).twist; },
          "(B, 6), angular [rad/s], then linear velocity [m/s], world axes");
}

}  // namespace

void bindWorld(py::module_& module) {
  bindBody(module);
  py::class_<PythonWorld, std::shared_ptr<PythonWorld>> type(
      module, "World",
      R"(A Bullet world with the bodies of a scene in their fluid; B bodies, in its order.

Other threads of Python run while it steps; one world is for one thread at a time.

Parameters
----------
scene : Scene
cache : a folder that keeps the fluid bodies that were solved

>>> with World(Scene("sphere_fall")) as world:
...     world.bodies["ball"].apply_force([1, 0, 0])
...     world.step()
...     bool(world.position[0, 0] > 0)
True
)");
  bindWorldMotion(type);
  type.def(py::init([](const Scene& scene, const py::object& cache) {
             return std::make_shared<PythonWorld>(
                 scene, cache.is_none() ? std::filesystem::path() : pathFrom(cache));
           }),
           py::arg("scene"), py::kw_only(), py::arg("cache") = py::none())
      .def(
          "step", [](PythonWorld& w, long long n) { w.step(n, [](const Simulation&) {}); },
          py::arg("n") = 1,
          "Makes n steps of the scene's time step. Raises FloatingPointError if a state is not "
          "finite.")
      .def("run", &run, py::arg("duration"), py::arg("output_step") = py::none(),
           "Goes on for so long [s]; the motion at multiples of the output step and at the end.")
      .def_property_readonly(
          "time", [](const PythonWorld& w) { return w.simulation().time(); }, "[s]")
      .def_property_readonly("bodies", &bodiesOf, "By name, in the order of the scene.")
      .def_property_readonly("scene", &PythonWorld::scene, "What it was made of.")
      .def_property_readonly(
          "warning", [](const PythonWorld& w) { return w.simulation().warning(); },
          "What the library has reported last; mostly empty.")
      .def(
          "state", [](const PythonWorld& w) { return py::bytes(w.simulation().saveState()); },
          "Everything that changes from step to step.")
      .def(
          "restore",
          [](PythonWorld& w, const py::bytes& state) {
            w.simulation().restoreState(std::string(state));
          },
          py::arg("state"),
          "Goes on from a state of this world or another one of the same scene: bit for bit, but "
          "where boxes, hulls and the like touch each other, whose contacts are found anew.")
      .def("close", &PythonWorld::close, "Frees its memory; nothing can be asked of it then.")
      .def("__enter__", [](const std::shared_ptr<PythonWorld>& w) { return w; })
      .def("__exit__", [](PythonWorld& w, const py::args&) { w.close(); });
}

}  // namespace ambient
