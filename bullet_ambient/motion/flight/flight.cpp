#include "bullet_ambient/motion/flight/flight.h"

#include <algorithm>
#include <cmath>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/force/surface/hydrostatics.h"
#include "bullet_ambient/spatial/inertia.h"

namespace ambient {

Wrench externalWrench(const BodyModel& model, const Surroundings& surroundings, const Matrix3& R) {
  AMBIENT_ASSERT(isRotation(R));
  const auto to_body = R.transpose();
  const Vector3 force = surroundings.applied.force - model.mass * surroundings.ambient_acceleration;
  const Vector3 gravity = to_body * (surroundings.gravity - surroundings.ambient_acceleration);
  return Wrench{to_body * surroundings.applied.torque, to_body * force} +
         buoyancy(model.displaced_mass, model.centre_of_volume, gravity);
}

double potentialEnergy(const BodyModel& model, const Surroundings& surroundings,
                       const FrameOffset& pose, double of_water) {
  const Vector3 force = surroundings.applied.force - model.mass * surroundings.ambient_acceleration;
  const Vector3 buoyancy =
      -model.displaced_mass * (surroundings.gravity - surroundings.ambient_acceleration);
  const Vector3 arm = pose.translation + pose.rotation * model.centre_of_volume;
  return of_water - force.dot(pose.translation) - buoyancy.dot(arm);
}

double velocityScale(const FlightTask& task) {
  const BodyModel& model = task.model;
  const Surroundings& s = task.surroundings;
  const double pull = (s.applied.force / model.mass - s.ambient_acceleration).norm();
  AMBIENT_ASSERT(model.mass > 0 && model.largest_mass > 0);
  return std::sqrt(model.largest_mass * pull * model.reference_length);
}

int substepsFor(double duration, double substep, int most) noexcept {
  if (!(substep > 0)) return 1;
  const double wanted = std::ceil(duration / substep * (1 - 1e-9));
  return wanted < most ? std::max(1, static_cast<int>(wanted)) : most;
}

void enterFrame(const Surroundings& s, RigidState& state) noexcept {
  state.twist.linear -= state.orientation.conjugate() * s.ambient_velocity;
}
void leaveFrame(const Surroundings& s, double t, RigidState& state) noexcept {
  state.position += t * s.ambient_velocity + t * t / 2 * s.ambient_acceleration;
  state.twist.linear +=
      state.orientation.conjugate() * (s.ambient_velocity + t * s.ambient_acceleration);
}

namespace {

static_assert(kFlightsTogether == kFlightLanes);

constexpr int kMaxRetries = 2;
constexpr double kStepSafety = 0.9;
constexpr double kDriftPrecision = 1e-6;  // precision of the flow over the tolerance, with loads
constexpr double kAcceptance = 2;         // error over tolerance above which a step is repeated

int maxSubsteps(const FlightTask& task) {
  if (task.settings.max_substeps > 0) return task.settings.max_substeps;
  return task.model.mass < task.model.largest_mass / 2 ? 64 : 16;
}

// Progress of one body through a step.
struct StepProgress {
  Flight* flight;
  int most;       // largest number of substeps
  int substeps;   // number of substeps of this attempt
  bool is_done;   // true if an attempt was accepted
  bool has_load;  // true if load_W holds a load, from which the next one is predicted
  double error;   // largest error of the substeps of this attempt, eq. (25)
  Growth growth;  // of the resistance at the last load
};

// Moves several bodies over one step, one per lane.
class Leapfrog {
 public:
  Leapfrog(Flight* const* flights, int count) : kernel_(*kFlightKernels.fastest()), count_(count) {
    AMBIENT_ASSERT(count > 0 && count <= kFlightLanes);
    if (count < kFlightLanes) lanes_ = {};
    setKinds(lanes_, count, [&](int i) -> const BodyModel& { return flights[i]->task.model; });
    for (int i = 0; i < count; ++i) begin(i, *flights[i]);
  }

  void fly() {
    for (int attempt = 0; attempt <= kMaxRetries; ++attempt) {
      int substeps = 0;
      for (int i = 0; i < count_; ++i) {
        if (progress_[i].is_done) continue;
        restart(i);
        substeps = std::max(substeps, progress_[i].substeps);
      }
      if (substeps == 0) return;
      advance(substeps);
      for (int i = 0; i < count_; ++i)
        if (!progress_[i].is_done) acceptOrRepeat(i, attempt);
    }
  }

 private:
  void begin(int i, Flight& flight) {
    const FlightTask& task = flight.task;
    const BodyModel& model = task.model;
    setModel(lanes_, i, model);
    setResistance(lanes_, i, model.resistance.get());
    setSurroundings(lanes_, i, task);
    lanes_.precision[i] = model.loads ? kDriftPrecision * task.settings.tolerance : task.precision;
    const int most = maxSubsteps(task);
    AMBIENT_ASSERT(most > 0 && !(flight.body.memory.substep < 0));
    progress_[i] = {&flight, most,  substepsFor(task.duration, flight.body.memory.substep, most),
                    false,   false, 0,
                    {}};
    flight.body.count = {};
  }

  void restart(int i) {
    StepProgress& progress = progress_[i];
    const FlightMemory& memory = progress.flight->body.memory;
    AMBIENT_ASSERT(progress.substeps > 0 && progress.substeps <= progress.most);
    setState(lanes_, i, progress.flight->task.model, progress.flight->body.state);
    progress.has_load = memory.has_load && progress.flight->task.model.loads;
    setLane(lanes_.load_W, i, progress.has_load ? memory.load_W : Wrench{});
    setLane(lanes_.load_B, i, Wrench{});
    lanes_.kick_time[i] = progress.flight->task.duration / progress.substeps;
    setGrowth(i, progress.has_load ? memory.growth : kCreeping);
    lanes_.error[i] = 0;
    progress.error = 0;
    lanes_.is_coarse[i] = 0;
    lanes_.energy_removed[i] = 0;
  }

  // Makes all substeps. The two half flows between kicks are made as one flow.
  void advance(int substeps) {
    for (int i = 0; i < count_; ++i) {
      lanes_.active[i] = progress_[i].is_done ? 0 : 1;
      lanes_.drift_time[i] = lanes_.kick_time[i] / 2;
    }
    if (lanes_.has_loads) kernel_.measure(lanes_);
    kernel_.drift(lanes_);
    for (int substep = 1; substep <= substeps; ++substep) {
      kick();
      for (int i = 0; i < count_; ++i)
        lanes_.drift_time[i] = lanes_.kick_time[i] / (substep < progress_[i].substeps ? 1 : 2);
      kernel_.drift(lanes_);
      for (int i = 0; i < count_; ++i)
        if (substep == progress_[i].substeps) lanes_.active[i] = 0;
    }
    boundEnergy();
  }

  // Scales the twist down if the energy has grown, eq. (25a): loads only take energy, but gravity
  // and flow in turns err to second order, with either sign.
  void boundEnergy() {
    if (!lanes_.has_loads) return;
    for (int i = 0; i < count_; ++i) {
      const bool has_loads = progress_[i].flight->task.model.loads != nullptr;
      lanes_.active[i] = !progress_[i].is_done && has_loads ? 1 : 0;
    }
    kernel_.bound(lanes_);
  }

  // Applies gravity and surface loads of a whole substep. The last load predicts the twist in the
  // middle of the substep, at which the new load is evaluated.
  void kick() {
    kernel_.applyGravity(lanes_);
    if (lanes_.has_loads) {
      evaluate(lanes_.twist_B, lanes_.predicted_load_B,
               [](const StepProgress& p) { return !p.has_load; });
      kernel_.sample(lanes_);
      evaluate(lanes_.sample_twist, lanes_.load_B, [](const StepProgress&) { return true; });
    }
    kernel_.kick(lanes_);
    for (int i = 0; i < count_; ++i) {
      if (!(lanes_.active[i] > 0)) continue;
      StepProgress& progress = progress_[i];
      ++progress.flight->body.count.substeps;
      progress.error = std::max(progress.error, lanes_.error[i]);
      progress.has_load = progress.flight->task.model.loads != nullptr;
    }
  }

  void setGrowth(int i, const Growth& growth) {
    progress_[i].growth = growth;
    const BodyModel& model = progress_[i].flight->task.model;
    ambient::setGrowth(lanes_, i, model.resistance ? growth : Growth{});
    lanes_.settling[i] = settlingIn(model, growth, lanes_.kick_time[i]);
  }

  template <class Condition>
  void evaluate(const FlightLane* twists, FlightLane* loads, const Condition& wants) {
    for (int i = 0; i < count_; ++i) {
      const FlightTask& task = progress_[i].flight->task;
      const BodyModel& model = task.model;
      if (!(lanes_.active[i] > 0) || !model.loads || !wants(progress_[i])) continue;
      const SurfaceLoad load = computeSurfaceLoad(model, twistOf(twists, i), task.surroundings);
      setLane(loads, i, load.wrench);
      setGrowth(i, load.growth);
      FlightCount& count = progress_[i].flight->body.count;
      ++count.load_evaluations;
      count.guarded += load.guarded;
    }
  }

  // Accepts the attempt, or sets a larger number of substeps for the next one.
  void acceptOrRepeat(int i, int attempt) {
    StepProgress& progress = progress_[i];
    const FlightTask& task = progress.flight->task;
    const double h = lanes_.kick_time[i];
    const double ratio = progress.error / task.settings.tolerance;
    const double next = ratio > 0 ? kStepSafety * h / std::sqrt(ratio) : 4 * h;
    if (!(ratio > kAcceptance) || attempt == kMaxRetries || progress.substeps == progress.most) {
      FlightResult& result = progress.flight->body;
      result.state = stateOf(lanes_, i, result.state.position);
      result.memory = {wrenchOf(lanes_.load_W, i), progress.growth, progress.has_load,
                       std::min(next, 4 * h)};
      const bool is_drift_coarse = lanes_.is_coarse[i] > 0;
      result.count.coarse = is_drift_coarse || ratio > kAcceptance;
      result.count.energy_removed = lanes_.energy_removed[i];
      if (result.count.coarse) result.count.error = is_drift_coarse ? 1 : progress.error;
      progress.is_done = true;
      return;
    }
    progress.substeps =
        std::max(progress.substeps + 1, substepsFor(task.duration, next, progress.most));
  }

  const FlightKernel& kernel_;
  int count_;
  FlightLanes lanes_;  // kernels and begin() write what is read of the lanes of all bodies
  StepProgress progress_[kFlightLanes];
};

}  // namespace

void flyLeapfrog(Flight* const* flights, int count) noexcept { Leapfrog(flights, count).fly(); }

namespace {

bool isFluidAtRest(const Surroundings& s) {
  return s.ambient_velocity.cwiseAbs().sum() + s.ambient_acceleration.cwiseAbs().sum() == 0;
}

// Moves up to kFlightsTogether bodies, whose states are in the frames that move with the flow.
void flyGroup(Flight* const* flights, int count) {
  Flight* leaps[kFlightsTogether];
  int leap_count = 0;
  for (int i = 0; i < count; ++i) {
    Flight& flight = *flights[i];
    if (const OwnFlight own = flight.task.settings.own_flight) {
      flight.body = own(flight.task, flight.body.state, flight.body.memory);
    } else {
      leaps[leap_count++] = &flight;
    }
  }
  if (leap_count > 0) flyLeapfrog(leaps, leap_count);
}

}  // namespace

void flyTogether(Flight* const* flights, int count) noexcept {
  for (int i = 0; i < count; ++i) {
    const Surroundings& s = flights[i]->task.surroundings;
    AMBIENT_ASSERT(flights[i]->task.duration > 0 && flights[i]->task.settings.tolerance > 0);
    if (!isFluidAtRest(s)) enterFrame(s, flights[i]->body.state);
  }
  for (int i = 0; i < count; i += kFlightsTogether)
    flyGroup(flights + i, std::min(kFlightsTogether, count - i));
  for (int i = 0; i < count; ++i) {
    const FlightTask& task = flights[i]->task;
    if (!isFluidAtRest(task.surroundings))
      leaveFrame(task.surroundings, task.duration, flights[i]->body.state);
  }
}

FlightResult fly(const FlightTask& task, const RigidState& start,
                 const FlightMemory& memory) noexcept {
  Flight flight(task, start, memory);
  Flight* const flights[] = {&flight};
  flyTogether(flights, 1);
  return flight.body;
}

namespace {

void setSymmetric(FlightLane (&to)[kSymmetricEntries], int body, const Matrix6& m,
                  bool is_diagonal) noexcept {
  for (int row = 0; row < 6; ++row) {
    to[symmetricEntry(row, row)][body] = m(row, row);
    if (is_diagonal) continue;
    for (int column = row + 1; column < 6; ++column)
      to[symmetricEntry(row, column)][body] = m(row, column);
  }
}

}  // namespace

void setModel(BodyLanes& lanes, int body, const BodyModel& model) noexcept {
  AMBIENT_ASSERT(isSymmetric(model.inertia, 1e-9) && isSymmetric(model.inverse_inertia, 1e-9));
  setSymmetric(lanes.inertia, body, model.inertia, lanes.has_diagonal_inertia);
  setSymmetric(lanes.inverse_inertia, body, model.inverse_inertia, lanes.has_diagonal_inertia);
  setLane(lanes.centre_of_volume_B, body, model.centre_of_volume);
}

void setResistance(BodyLanes& lanes, int body, const Resistance* resistance) noexcept {
  if (!lanes.has_resistance) return;
  static const Resistance kNone;
  const Resistance& of = resistance ? *resistance : kNone;
  for (int row = 0; row < 6; ++row) lanes.resistance_there[row][row][body] = of.matrix(row, row);
  if (lanes.has_diagonal_inertia) return;
  for (int row = 0; row < 6; ++row)
    for (int column = 0; column < 6; ++column)
      if (column != row) lanes.resistance_there[row][column][body] = of.matrix(row, column);
  setLane(lanes.centre_of_reaction, body, of.centre);
}

void setGrowth(BodyLanes& lanes, int body, const Growth& growth) noexcept {
  lanes.growth[0][body] = growth.rotation;
  lanes.growth[1][body] = growth.translation;
}

void setForces(BodyLanes& lanes, int body, const FlightTask& task) noexcept {
  const BodyModel& model = task.model;
  const Surroundings& s = task.surroundings;
  setLane(lanes.torque_W, body, s.applied.torque);
  setLane(lanes.force_W, body, Vector3(s.applied.force - model.mass * s.ambient_acceleration));
  setLane(lanes.buoyancy_W, body,
          Vector3(-model.displaced_mass * (s.gravity - s.ambient_acceleration)));
}

void setSurroundings(FlightLanes& lanes, int body, const FlightTask& task) noexcept {
  setForces(lanes, body, task);
  lanes.velocity_scale[body] = velocityScale(task);
}

void setState(FlightLanes& lanes, int body, const BodyModel& model,
              const RigidState& state) noexcept {
  // Written so that NaN passes: the flight of a state that is not finite is rejected later.
  AMBIENT_ASSERT(!(std::abs(state.orientation.squaredNorm() - 1) > 1e-6));
  setLane(lanes.orientation, body, state.orientation);
  setLane(lanes.displacement_W, body, Vector3(0, 0, 0));
  const DualPair motion = pairOfTwist(model, state.twist.vector());
  for (int i = 0; i < 6; ++i) {
    lanes.twist_B[i][body] = motion.twist[i];
    lanes.momentum_B[i][body] = motion.momentum[i];
  }
}

RigidState stateOf(const FlightLanes& lanes, int body, const Vector3& start) noexcept {
  return {orientationOf(lanes.orientation, body), start + vectorOf(lanes.displacement_W, body),
          twistOf(lanes.twist_B, body)};
}

}  // namespace ambient
