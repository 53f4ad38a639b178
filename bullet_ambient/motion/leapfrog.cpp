#include <algorithm>
#include <cmath>

#include "bullet_ambient/motion/flight_group.h"
#include "bullet_ambient/motion/integrators.h"

namespace ambient {
namespace {

static_assert(kFlightsTogether == kFlightLanes);

constexpr int kMaxRetries = 2;
constexpr double kStepSafety = 0.9;
constexpr double kToRounding = 1e-16;
constexpr double kFlowPrecision = 1e-6;  // of the tolerance: the flow adds nothing to the error
constexpr double kAcceptance =
    2;  // a step is repeated when its error exceeds the tolerance by this factor

int maxSubsteps(const FlightTask& task) {
  if (task.settings.max_substeps > 0) return task.settings.max_substeps;
  return task.model.mass < task.model.largest_mass / 2 ? 64 : 16;
}

int substepsFor(double duration, double substep, int most) {
  if (!(substep > 0)) return 1;
  const double wanted = std::ceil(duration / substep * (1 - 1e-9));
  return wanted < most ? std::max(1, static_cast<int>(wanted)) : most;
}

// One body on its way through a step.
struct Way {
  Flight* flight;
  int most;       // substeps
  int substeps;   // of this attempt
  bool is_done;   // an attempt was accepted
  bool has_load;  // load_W is there to guess the next one from
  double error;   // largest of this attempt
};

// Several bodies over one step, side by side.
class Leapfrog {
 public:
  Leapfrog(Flight* const* flights, int count) : kernel_(fastestFlightKernel()), count_(count) {
    lanes_.has_diagonal_inertia = true;
    for (int i = 0; i < count; ++i) begin(i, *flights[i]);
  }

  void fly() {
    for (int attempt = 0; attempt <= kMaxRetries; ++attempt) {
      int substeps = 0;
      for (int i = 0; i < count_; ++i) {
        if (ways_[i].is_done) continue;
        restart(i);
        substeps = std::max(substeps, ways_[i].substeps);
      }
      if (substeps == 0) return;
      advance(substeps);
      for (int i = 0; i < count_; ++i)
        if (!ways_[i].is_done) judge(i, attempt);
    }
  }

 private:
  void begin(int i, Flight& flight) {
    const FlightTask& task = flight.task;
    const BodyModel& model = task.model;
    setModel(lanes_, i, model);
    setSurroundings(lanes_, i, task);
    lanes_.has_diagonal_inertia = lanes_.has_diagonal_inertia && model.has_diagonal_inertia;
    lanes_.has_loads = lanes_.has_loads || model.loads;
    lanes_.precision[i] = model.loads ? kFlowPrecision * task.settings.tolerance : kToRounding;
    const int most = maxSubsteps(task);
    ways_[i] = {&flight, most,  substepsFor(task.duration, flight.body.memory.substep, most),
                false,   false, 0};
    flight.body.count = {};
  }

  void restart(int i) {
    Way& way = ways_[i];
    const FlightMemory& memory = way.flight->body.memory;
    setState(lanes_, i, way.flight->task.model, way.flight->body.state);
    way.has_load = memory.has_load && way.flight->task.model.loads;
    setLane(lanes_.load_W, i, way.has_load ? memory.load_W : Wrench{});
    way.error = 0;
    lanes_.kick_time[i] = way.flight->task.duration / way.substeps;
    lanes_.is_coarse[i] = 0;
    lanes_.energy_removed[i] = 0;
  }

  // All substeps. The half flows between two kicks are one flow: it is exact.
  void advance(int substeps) {
    for (int i = 0; i < count_; ++i) {
      lanes_.active[i] = ways_[i].is_done ? 0 : 1;
      lanes_.flow_time[i] = lanes_.kick_time[i] / 2;
    }
    if (lanes_.has_loads) kernel_.measure(lanes_);
    kernel_.flow(lanes_);
    for (int substep = 1; substep <= substeps; ++substep) {
      kick();
      for (int i = 0; i < count_; ++i)
        lanes_.flow_time[i] = lanes_.kick_time[i] / (substep < ways_[i].substeps ? 1 : 2);
      kernel_.flow(lanes_);
      for (int i = 0; i < count_; ++i)
        if (substep == ways_[i].substeps) lanes_.active[i] = 0;
    }
    boundEnergy();
  }

  // Loads only take energy. Gravity and flow in turns err to second order, on either side: a body
  // with loads keeps to the lower one, eq. (25a).
  void boundEnergy() {
    if (!lanes_.has_loads) return;
    for (int i = 0; i < count_; ++i) {
      const bool has_loads = ways_[i].flight->task.model.loads != nullptr;
      lanes_.active[i] = !ways_[i].is_done && has_loads ? 1 : 0;
    }
    kernel_.bound(lanes_);
  }

  // Gravity and surface loads over the whole substep; those of the last one predict the motion in
  // its middle.
  void kick() {
    kernel_.fall(lanes_);
    if (lanes_.has_loads) {
      evaluate(lanes_.twist_B, lanes_.guess_B, [](const Way& way) { return !way.has_load; });
      kernel_.sample(lanes_);
      evaluate(lanes_.sample_twist, lanes_.load_B, [](const Way&) { return true; });
    }
    kernel_.kick(lanes_);
    for (int i = 0; i < count_; ++i) {
      if (!(lanes_.active[i] > 0)) continue;
      Way& way = ways_[i];
      ++way.flight->body.count.substeps;
      way.error = std::max(way.error, lanes_.error[i]);
      way.has_load = way.flight->task.model.loads != nullptr;
    }
  }

  template <class Condition>
  void evaluate(const FlightLane* twists, FlightLane* loads, const Condition& wants) {
    for (int i = 0; i < count_; ++i) {
      const BodyModel& model = ways_[i].flight->task.model;
      if (!(lanes_.active[i] > 0) || !model.loads || !wants(ways_[i])) continue;
      const SurfaceLoad load = computeSurfaceLoad(model, twistOf(twists, i));
      setLane(loads, i, load.wrench);
      FlightCount& count = ways_[i].flight->body.count;
      ++count.load_evaluations;
      count.guarded += load.guarded;
    }
  }

  // Accepts the attempt, or asks for one with more substeps.
  void judge(int i, int attempt) {
    Way& way = ways_[i];
    const FlightTask& task = way.flight->task;
    const double h = lanes_.kick_time[i];
    const double ratio = way.error / task.settings.tolerance;
    const double next = ratio > 0 ? kStepSafety * h / std::sqrt(ratio) : 4 * h;
    if (!(ratio > kAcceptance) || attempt == kMaxRetries || way.substeps == way.most) {
      FlightResult& result = way.flight->body;
      result.state = stateOf(lanes_, i, result.state.position);
      result.memory = {wrenchOf(lanes_.load_W, i), way.has_load, std::min(next, 4 * h)};
      const bool is_flow_coarse = lanes_.is_coarse[i] > 0;
      result.count.coarse = is_flow_coarse || ratio > kAcceptance;
      result.count.energy_removed = lanes_.energy_removed[i];
      if (result.count.coarse) result.count.error = is_flow_coarse ? 1 : way.error;
      way.is_done = true;
      return;
    }
    way.substeps = std::max(way.substeps + 1, substepsFor(task.duration, next, way.most));
  }

  const FlightKernel& kernel_;
  int count_;
  FlightLanes lanes_{};
  Way ways_[kFlightLanes];
};

}  // namespace

void flyLeapfrog(Flight* const* flights, int count) noexcept { Leapfrog(flights, count).fly(); }

}  // namespace ambient
