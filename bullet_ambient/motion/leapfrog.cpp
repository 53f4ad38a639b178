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

Wrench toWorld(const Matrix3& R, const Wrench& f) { return {R * f.torque, R * f.force}; }
Wrench toBody(const Matrix3& R, const Wrench& f) {
  return {R.transpose() * f.torque, R.transpose() * f.force};
}

// One body on its way through the substeps of a step.
struct Way {
  MomentumState state;
  FlightMemory memory;
  FlightCount count;
};

// The part of one substep between its half flows: gravity and surface loads.
class Kick {
 public:
  Kick(const FlightTask& task, double duration)
      : task_(task), model_(task.model), h_(duration), fall_scale_(fallScale(task)) {}

  // Returns the error estimate of eq. (25).
  double act(Way& way) const {
    const Matrix3 R = way.state.orientation.toRotationMatrix();
    const Wrench external = externalWrench(model_, task_.surroundings, R);
    const DualPair fall = h_ / 2 * pairOfMomentum(model_, external.vector());
    DualPair& x = way.state.motion;
    x += fall;
    const double error = model_.has_surface_loads ? actByLoads(way, R) : 0;
    x += fall;
    ++way.count.substeps;
    return error;
  }

 private:
  // Surface loads over the whole substep, predicted by those of the last one.
  double actByLoads(Way& way, const Matrix3& R) const {
    DualPair& x = way.state.motion;
    const Wrench guess =
        way.memory.has_load ? toBody(R, way.memory.load_W) : evaluate(way, x.twist);
    const LoadSample before{x, pairOfMomentum(model_, guess.vector())};
    const DualPair mid = passiveKick(x, before, h_ / 2);
    const Wrench load = evaluate(way, mid.twist);
    way.memory.load_W = toWorld(R, load);
    way.memory.has_load = true;
    const LoadSample sample{mid, pairOfMomentum(model_, load.vector())};
    const double error = relativeError(x, sample.load - before.load);
    x = passiveKick(x, sample, h_);
    return error;
  }

  Wrench evaluate(Way& way, const Vector6& x) const {
    const SurfaceLoad load = computeSurfaceLoad(model_, Twist::fromVector(x));
    ++way.count.load_evaluations;
    way.count.guarded += load.guarded;
    return load.wrench;
  }

  // The floor keeps a body at the turning point of its swing from asking for ever smaller substeps:
  // speeds far below sqrt(g L) move it by little of its own size while gravity turns them over.
  double relativeError(const DualPair& x, const DualPair& load_change) const {
    const double change = h_ * std::sqrt(inner(load_change, load_change));
    const double scale = std::sqrt(inner(x, x)) + fall_scale_;
    return scale > 0 ? change / scale : 0;
  }

  const FlightTask& task_;
  const BodyModel& model_;
  double h_;
  double fall_scale_;
};

// All substeps of length h; returns the largest error. The half flows between two kicks are one
// flow: it is exact.
double advance(const FlightTask& task, double h, int substeps, Way& way) {
  const Kick kick(task, h);
  const double precision =
      task.model.has_surface_loads ? kFlowPrecision * task.settings.tolerance : kToRounding;
  const auto flow = [&](double duration) {
    const Flow end = flowWithoutLoads(task.model, way.state, duration, precision);
    way.state = end.state;
    way.count.coarse = way.count.coarse || !end.is_precise;
  };
  double error = 0;
  flow(h / 2);
  for (int i = 1; i <= substeps; ++i) {
    error = std::max(error, kick.act(way));
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
  const MomentumState begin = MomentumState::of(task.model, start);
  int substeps = substepsFor(task.duration, memory.substep, most);
  FlightCount spent;
  for (int attempt = 0;; ++attempt) {
    Way way{begin, memory, {}};
    const double h = task.duration / substeps;
    const double ratio = advance(task, h, substeps, way) / task.settings.tolerance;
    const double next = ratio > 0 ? kSafety * h / std::sqrt(ratio) : 4 * h;
    way.memory.substep = std::min(next, 4 * h);
    spent.substeps += way.count.substeps;
    spent.load_evaluations += way.count.load_evaluations;
    spent.guarded += way.count.guarded;
    if (!(ratio > kAcceptance) || attempt == kMaxRetries || substeps == most) {
      spent.coarse = way.count.coarse || (ratio > kAcceptance && substeps == most);
      return {way.state.rigidState(), way.memory, spent};
    }
    substeps = std::max(substeps + 1, substepsFor(task.duration, next, most));
  }
}

}  // namespace ambient
