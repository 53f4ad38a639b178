#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <algorithm>
#include <array>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "demos/simulation/body_preparation.h"
#include "demos/simulation/robots/scene_robot.h"
#include "demos/simulation/scene_body_cache.h"
#include "demos/simulation/simulation.h"

namespace ambient {

/// Simulation owned by Python. One thread at a time may use it. Nothing can be asked of it after
/// close(). What the library reports is a warning of Python.
class PythonWorld {
 public:
  /// `flow`: as that of Simulation.
  PythonWorld(const Scene& scene, const BodyFolder& cache, bool takes_robots,
              const FlowField& flow = nullptr)
      : scene_(scene), fluid_bodies_(cache, scene.threads) {
    {
      const pybind11::gil_scoped_release others_run;
      simulation_ = std::make_unique<Simulation>(scene, prepare(scene), takes_robots, flow);
    }
    warn();
  }

  const Scene& scene() const { return scene_; }
  Simulation& simulation() const {
    if (!simulation_) throw pybind11::value_error("the world is closed");
    if (is_stepping_) throw std::logic_error("the world is in use by another thread");
    return *simulation_;
  }
  /// Adds the robots at the end of `scene` that the world does not have. @pre otherwise `scene`
  /// equals that of the world
  void addRobots(const Scene& scene) {
    Simulation& joined = simulation();
    const Stepping in_use(is_stepping_);
    {
      const pybind11::gil_scoped_release others_run;
      joined.addRobots(scene, prepare(scene));
    }
    scene_ = scene;
    warn();
  }
  /// Takes water and regions of a scene that differs from that of the world in these alone.
  void setRegions(const Scene& scene) {
    simulation().setRegions(scene);
    scene_ = scene;
  }
  MotionSample sample(std::size_t body) const { return simulation().sample()[body]; }
  void close() { simulation_.reset(); }

  /// Makes `steps` steps and calls `take` with the simulation after each. Releases the
  /// interpreter's lock meanwhile. Checks for keyboard interrupts every kChunk steps.
  template <class Take>
  void step(long long steps, const Take& take) {
    constexpr long long kChunk = 100;
    Simulation& stepped = simulation();
    const Stepping in_use(is_stepping_);
    for (long long done = 0; done < steps;) {
      const long long end = std::min(steps, done + kChunk);
      stepFreely(stepped, end - done, take);
      done = end;
      warn();
      if (PyErr_CheckSignals() != 0) throw pybind11::error_already_set();
    }
  }

 private:
  // Sets a flag as long as it lives.
  struct Stepping {
    explicit Stepping(bool& flag) : flag_(flag) { flag_ = true; }
    ~Stepping() { flag_ = false; }
    bool& flag_;
  };

  template <class Take>
  static void stepFreely(Simulation& stepped, long long steps, const Take& take) {
    try {
      const pybind11::gil_scoped_release others_run;
      for (long long i = 0; i < steps; ++i) {
        stepped.step();
        take(stepped);
      }
    } catch (const std::runtime_error& error) {
      PyErr_SetString(PyExc_FloatingPointError, error.what());
      throw pybind11::error_already_set();
    }
  }

  // Warns of the sentences that the library has reported since the last call.
  void warn() {
    if (told_ == simulation_->warning().size()) return;
    std::istringstream news(simulation_->warning().substr(told_));
    told_ = simulation_->warning().size();
    for (std::string sentence; std::getline(news, sentence);)
      if (!sentence.empty() && PyErr_WarnEx(PyExc_UserWarning, sentence.c_str(), 1) != 0)
        throw pybind11::error_already_set();
  }

  std::vector<PreparedBody> prepare(const Scene& scene) {
    std::vector<PreparedBody> bodies = prepareBodies(scene, fluid_bodies_);
    fluid_bodies_.save();
    return bodies;
  }

  Scene scene_;
  SceneBodyCache fluid_bodies_;
  std::unique_ptr<Simulation> simulation_;
  std::size_t told_ = 0;      // characters of its warning() that warn() has told
  bool is_stepping_ = false;  // true: a thread steps the world; guarded by the interpreter's lock
};

constexpr char kLinesText[] =
    R"(Returns the lines of Bullet's debug drawing: points (L, 2, 3) [m] and colours (L, 3), float32.

drawing : what is drawn of the fluid besides the bodies, after the first step: "separation", "slip_velocity", "pressure",
    "friction", "buoyancy", "total_wrench", "centre_of_volume", "water_surface", "holds",
    "wings")";

/// Draws a world, see kLinesText. @throws ValueError, one line, if there is no such drawing
inline pybind11::tuple linesOf(Simulation& simulation, const std::vector<std::string>& drawing) {
  constexpr std::array<std::pair<bool FluidDrawing::*, const char*>, 10> kDrawings{
      {{&FluidDrawing::separation, "separation"},
       {&FluidDrawing::slip_velocity, "slip_velocity"},
       {&FluidDrawing::pressure, "pressure"},
       {&FluidDrawing::friction, "friction"},
       {&FluidDrawing::buoyancy, "buoyancy"},
       {&FluidDrawing::total_wrench, "total_wrench"},
       {&FluidDrawing::centre_of_volume, "centre_of_volume"},
       {&FluidDrawing::water_surface, "water_surface"},
       {&FluidDrawing::holds, "holds"},
       {&FluidDrawing::wings, "wings"}}};
  FluidDrawing what;
  for (const std::string& word : drawing) {
    const auto found = valueOf(kDrawings, word);
    if (!found)
      throw pybind11::value_error("drawing has \"" + word +
                                  "\", which help(World.lines) does not list");
    what.*(*found) = true;
  }
  const WorldLines lines = simulation.lines(what);
  const auto count = static_cast<pybind11::ssize_t>(lines.colours.size() / 3);
  pybind11::array_t<float> points({count, pybind11::ssize_t{2}, pybind11::ssize_t{3}});
  pybind11::array_t<float> colours({count, pybind11::ssize_t{3}});
  std::copy(lines.points.begin(), lines.points.end(), points.mutable_data());
  std::copy(lines.colours.begin(), lines.colours.end(), colours.mutable_data());
  return pybind11::make_tuple(points, colours);
}

/// One robot of a world; keeps the world alive.
struct PythonRobot {
  std::shared_ptr<PythonWorld> world;
  std::size_t index = 0;

  SceneRobot& get() const { return world->simulation().robot(index); }
};

}  // namespace ambient
