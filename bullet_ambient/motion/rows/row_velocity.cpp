#include "bullet_ambient/motion/rows/row_velocity.h"

#include <algorithm>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/motion/body/one_body.h"
#include "bullet_ambient/motion/flight/flight.h"
#include "bullet_ambient/motion/lanes/body_kernel.h"
#include "bullet_ambient/motion/lanes/flight_lanes.h"
#include "bullet_ambient/spatial/cholesky.h"

namespace ambient {

namespace {

void setEvenResponse(RowLanes& lanes, int body, const EvenResponse& response) {
  for (int row = 0; row < 3; ++row)
    setLane(lanes.even_inverse_inertia[row], body, Vector3(response.inverse_inertia.row(row)));
  lanes.even_inverse_mass[body] = response.inverse_mass;
}

}  // namespace

Wrench meanLoadInTurningFluid(const FlightTask& task, const BodyModel& model, const Twist& relative,
                              const Wrench& load) noexcept {
  const FlowAlongBody& flow = *task.surroundings.flow;
  Twist seen = relative;
  seen.angular -= flow.twists_B[0].angular;
  const Wrench whole = load + flow.at_rest_B;
  const PairsOf<double> motion = plain(pairOfTwist(model, seen.vector()));
  const PairsOf<double> sample = plain(pairOfTwist(model, model.inverse_inertia * whole.vector()));
  const Vector6 change =
      asEigen(passiveKick(motion, motion, sample, task.duration).twist - motion.twist);
  Wrench mean = Wrench::fromVector(model.inertia * change / task.duration);
  return mean -= flow.at_rest_B;
}

void setModels(const BodyModel* const* models, int count, RowLanes& lanes) noexcept {
  AMBIENT_ASSERT(count > 0 && count <= kFlightsTogether);
  if (count < kFlightLanes) lanes = {};
  setKinds(lanes, count, [&](int i) -> const BodyModel& { return *models[i]; });
  for (int i = 0; i < count; ++i) {
    lanes.active[i] = 1;
    setModel(lanes, i, *models[i]);
  }
}

std::optional<Matrix6> settledInertia(const BodyModel& model, const SurfaceLoad& load,
                                      const Twist& relative, double duration) noexcept {
  if (!(settlingIn(model, load.growth, duration) > 0)) return std::nullopt;
  const double energy = inertiaNormSquared(model, relative.vector());
  const double drag = energy > 0 ? std::max(0.0, -power(load.wrench, relative) / energy) : 0.0;
  const Matrix6 inertia =
      (1 + duration * drag) * model.inertia + duration * model.resistance->grown(load.growth);
  if (!inertia.allFinite() || !Cholesky<6>(inertia).isPositive()) return std::nullopt;
  return inertia;
}

RowLoad setStart(const FlightTask& task, const RigidState& start, int lane,
                 RowLanes& lanes) noexcept {
  const Surroundings& s = task.surroundings;
  AMBIENT_ASSERT(task.duration > 0);
  lanes.kick_time[lane] = task.duration;
  setForces(lanes, lane, task);
  setLane(lanes.acceleration_W, lane, s.ambient_acceleration);
  setEvenResponse(lanes, lane, task.model.even_response);
  Twist relative = start.twist;
  if (!s.ambient_velocity.isZero(0))
    relative.linear -= start.orientation.conjugate() * s.ambient_velocity;
  setLane(lanes.orientation, lane, start.orientation);
  setLane(lanes.twist_B, lane, relative);
  setLane(lanes.load_B, lane, Wrench{});
  setResistance(lanes, lane, nullptr, {});
  lanes.settling[lane] = 0;
  RowLoad row;
  if (!task.model.loads) return row;
  const SurfaceLoad load = computeSurfaceLoad(task.model, relative, s);
  setResistance(lanes, lane, task.model.resistance.get(), load.growth);
  const bool is_constant = turnsWithFluid(s);
  row.settled_inertia =
      settledInertia(task.model, is_constant ? SurfaceLoad{{}, false, load.growth} : load, relative,
                     task.duration);
  if (row.settled_inertia)
    lanes.settling[lane] = settlingIn(task.model, load.growth, task.duration);
  if (is_constant) {
    const Wrench mean = meanLoadInTurningFluid(task, task.model, relative, load.wrench);
    Surroundings with = s;
    const Quaternion& q = start.orientation;
    with.applied += {q * mean.torque, q * mean.force};
    setForces(lanes, lane, {task.model, with, task.settings, task.duration});
  } else {
    setLane(lanes.load_B, lane, load.wrench);
  }
  row.count.load_evaluations = 1;
  row.count.guarded = load.guarded;
  return row;
}

RowVelocity rowVelocityOf(const RowLanes& lanes, int lane, const RowLoad& load) noexcept {
  return {twistOf(lanes.change_W, lane),
          twistOf(lanes.turning_W, lane),
          twistOf(lanes.isotropic_excess_W, lane),
          lanes.extent[lane],
          load.count,
          lanes.settling[lane] > 0 ? load.settled_inertia : std::nullopt};
}

RowVelocity computeRowVelocity(const FlightTask& task, const RigidState& start) noexcept {
  RowLanes lanes;
  const BodyModel* const model = &task.model;
  setModels(&model, 1, lanes);
  const RowLoad load = setStart(task, start, 0, lanes);
  kFlightKernels.fastest()->push(lanes);
  return rowVelocityOf(lanes, 0, load);
}

}  // namespace ambient
