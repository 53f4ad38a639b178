#include "bullet_ambient/motion/leapfrog.h"

#include <algorithm>
#include <cmath>

#include "bullet_ambient/motion/kirchhoff_flow.h"
#include "bullet_ambient/motion/passive_kick.h"

namespace ambient {
namespace {

constexpr int kMaxRetries = 2;
constexpr double kSafety = 0.9;
constexpr double kFlowPrecision = 1e-6;  // of the tolerance: the flow adds nothing to the error
constexpr double kAcceptance =
    2;  // a step is repeated when its error exceeds the tolerance by this factor

Wrench turnedBy(const Quaternion& q, const Wrench& f) { return {q * f.torque, q * f.force}; }

// The part of one substep between its half flows: gravity and surface loads.
class Kick {
 public:
  Kick(const FlightTask& task, double duration) : task_(task), model_(task.model), h_(duration) {}

  // Returns the error estimate of eq. (25).
  double act(FlightResult& flight) const {
    const Wrench external = externalWrench(model_, task_.surroundings, flight.state.orientation);
    const Vector6 fall = h_ / 2 * (model_.inverse_inertia * external.vector());
    const Vector6 x = flight.state.twist.vector() + fall;
    const Loaded loaded = model_.has_surface_loads ? kickByLoads(flight, x) : Loaded{x, 0};
    flight.state.twist = Twist::fromVector(loaded.x + fall);
    ++flight.count.substeps;
    return loaded.error;
  }

 private:
  struct Loaded {
    Vector6 x;
    double error;
  };

  // Surface loads over the whole substep, predicted by those of the last one.
  Loaded kickByLoads(FlightResult& flight, const Vector6& x) const {
    const Quaternion& q = flight.state.orientation;
    const Wrench guess = flight.memory.has_load ? turnedBy(q.conjugate(), flight.memory.load_W)
                                                : evaluate(flight, x);
    const Vector6 mid = passiveKick(model_, x, {x, guess.vector()}, h_ / 2);
    const Wrench load = evaluate(flight, mid);
    flight.memory.load_W = turnedBy(q, load);
    flight.memory.has_load = true;
    const Vector6 change = load.vector() - guess.vector();
    return {passiveKick(model_, x, {mid, load.vector()}, h_), relativeError(x, change)};
  }

  Wrench evaluate(FlightResult& flight, const Vector6& x) const {
    const SurfaceLoad load = computeSurfaceLoad(model_, Twist::fromVector(x));
    ++flight.count.load_evaluations;
    flight.count.guarded += load.guarded;
    return load.wrench;
  }

  // The floor keeps a body at the turning point of its swing from asking for ever smaller substeps:
  // speeds far below sqrt(g L) move it by little of its own size while gravity turns them over.
  double relativeError(const Vector6& x, const Vector6& load_change) const {
    const double change = h_ * std::sqrt(load_change.dot(model_.inverse_inertia * load_change));
    const double scale = motionScale(task_, x);
    return scale > 0 ? change / scale : 0;
  }

  const FlightTask& task_;
  const BodyModel& model_;
  double h_;
};

// All substeps of length h; returns the largest error. The half flows between two kicks are one
// flow: it is exact.
double advance(const FlightTask& task, double h, int substeps, FlightResult& flight) {
  const Kick kick(task, h);
  const double precision =
      task.model.has_surface_loads ? kFlowPrecision * task.settings.tolerance : kToRounding;
  const auto flow = [&](double duration) {
    const Flow end = flowWithoutLoads(task.model, flight.state, duration, precision);
    flight.state = end.state;
    flight.count.coarse = flight.count.coarse || !end.is_precise;
  };
  double error = 0;
  flow(h / 2);
  for (int i = 1; i <= substeps; ++i) {
    error = std::max(error, kick.act(flight));
    flow(i < substeps ? h : h / 2);
  }
  return error;
}

int maxSubsteps(const FlightTask& task) {
  if (task.settings.max_substeps > 0) return task.settings.max_substeps;
  return task.model.mass < task.model.largest_mass / 2 ? 64 : 16;
}

int substepsFor(double duration, double substep, int most) {
  if (!(substep > 0)) return 1;
  const double wanted = std::ceil(duration / substep * (1 - 1e-9));
  return wanted < most ? std::max(1, static_cast<int>(wanted)) : most;
}

}  // namespace

FlightResult flyLeapfrog(const FlightTask& task, const RigidState& start,
                         const FlightMemory& memory) noexcept {
  const int most = maxSubsteps(task);
  int substeps = substepsFor(task.duration, memory.substep, most);
  FlightCount spent;
  for (int attempt = 0;; ++attempt) {
    FlightResult flight{start, memory, {}};
    const double h = task.duration / substeps;
    const double ratio = advance(task, h, substeps, flight) / task.settings.tolerance;
    const double next = ratio > 0 ? kSafety * h / std::sqrt(ratio) : 4 * h;
    flight.memory.substep = std::min(next, 4 * h);
    spent.substeps += flight.count.substeps;
    spent.load_evaluations += flight.count.load_evaluations;
    spent.guarded += flight.count.guarded;
    if (!(ratio > kAcceptance) || attempt == kMaxRetries || substeps == most) {
      spent.coarse = flight.count.coarse || (ratio > kAcceptance && substeps == most);
      flight.count = spent;
      return flight;
    }
    substeps = std::max(substeps + 1, substepsFor(task.duration, next, most));
  }
}

}  // namespace ambient
