#include "bullet_ambient/motion/rows/row_velocity.h"

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/motion/body/one_body.h"
#include "bullet_ambient/motion/flight/flight_group.h"
#include "bullet_ambient/motion/lanes/body_kernel.h"
#include "bullet_ambient/motion/lanes/flight_lanes.h"

namespace ambient {

namespace {

void setEvenResponse(PushLanes& lanes, int body, const EvenResponse& response) {
  for (int row = 0; row < 3; ++row)
    setLane(lanes.even_inverse_inertia[row], body, Vector3(response.inverse_inertia.row(row)));
  lanes.even_inverse_mass[body] = response.inverse_mass;
}

// Writes a body into its lane, with the load at the start. Returns what the load cost.
FlightCount begin(const RowTask& body, int lane, PushLanes& push) {
  const FlightTask& task = body.task;
  const Surroundings& s = task.surroundings;
  AMBIENT_ASSERT(task.duration > 0);
  FlightLanes& lanes = push.bodies;
  lanes.active[lane] = 1;
  lanes.kick_time[lane] = task.duration;
  setModel(lanes, lane, task.model);
  setForces(lanes, lane, task);
  setLane(push.acceleration_W, lane, s.ambient_acceleration);
  setEvenResponse(push, lane, task.model.even_response);
  Twist relative = body.start.twist;
  if (!s.ambient_velocity.isZero(0))
    relative.linear -= body.start.orientation.conjugate() * s.ambient_velocity;
  setLane(lanes.orientation, lane, body.start.orientation);
  setLane(lanes.twist_B, lane, relative);
  setLane(lanes.load_B, lane, Wrench{});
  FlightCount count;
  if (!task.model.loads) return count;
  const SurfaceLoad load = computeSurfaceLoad(task.model, relative, s);
  if (turnsWithFluid(s)) {
    const Wrench mean = meanLoadInTurningFluid(task, task.model, relative, load.wrench);
    Surroundings with = s;
    const Quaternion& q = body.start.orientation;
    with.applied += {q * mean.torque, q * mean.force};
    setForces(lanes, lane, {task.model, with, task.settings, task.duration});
  } else {
    setLane(lanes.load_B, lane, load.wrench);
  }
  count.load_evaluations = 1;
  count.guarded = load.guarded;
  return count;
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

void computeRowVelocities(const RowTask* const* bodies, int count, RowVelocity* results) noexcept {
  AMBIENT_ASSERT(count > 0 && count <= kFlightsTogether);
  PushLanes push;
  if (count < kFlightLanes) push = {};
  setKinds(push.bodies, count, [&](int i) -> const BodyModel& { return bodies[i]->task.model; });
  for (int i = 0; i < count; ++i) results[i].count = begin(*bodies[i], i, push);
  kFlightKernels.fastest()->push(push);
  for (int i = 0; i < count; ++i) {
    results[i].change_W = twistOf(push.change_W, i);
    results[i].turning_W = twistOf(push.turning_W, i);
    results[i].isotropic_excess_W = twistOf(push.isotropic_excess_W, i);
    results[i].extent = push.extent[i];
  }
}

RowVelocity computeRowVelocity(const FlightTask& task, const RigidState& start) noexcept {
  const RowTask body{task, start};
  const RowTask* const one = &body;
  RowVelocity result;
  computeRowVelocities(&one, 1, &result);
  return result;
}

namespace {

// Writes bodies into lanes: their models and orientations.
template <class Body>
class BodiesInLanes {
 public:
  BodiesInLanes(const Body* const* bodies, int count) {
    AMBIENT_ASSERT(count > 0 && count <= kFlightsTogether);
    if (count < kFlightLanes) lanes = {};
    setKinds(lanes.bodies, count, [&](int i) -> const BodyModel& { return bodies[i]->model; });
    for (int i = 0; i < count; ++i) {
      lanes.bodies.active[i] = 1;
      setModel(lanes.bodies, i, bodies[i]->model);
      setLane(lanes.bodies.orientation, i, bodies[i]->orientation);
    }
  }

  RowMotionLanes lanes;
};

}  // namespace

void computeKeptMotions(const BodyWithRows* const* bodies, int count, double duration,
                        KeptMotion* results) noexcept {
  AMBIENT_ASSERT(duration > 0);
  BodiesInLanes some(bodies, count);
  for (int i = 0; i < count; ++i) {
    some.lanes.bodies.kick_time[i] = duration;
    setLane(some.lanes.velocity_W, i, bodies[i]->velocity_W);
    setLane(some.lanes.turning_W, i, bodies[i]->turning_W);
    setLane(some.lanes.by_rows_W, i, bodies[i]->by_rows_W);
  }
  kFlightKernels.fastest()->keep(some.lanes);
  for (int i = 0; i < count; ++i) {
    const FlightLane* m = some.lanes.momentum_W;
    results[i] = {
        {vectorOf(m, i), vectorOf(m + 3, i)}, some.lanes.extent[i], some.lanes.twice_energy[i]};
  }
}

void computeCarriedTwists(const CarriedBody* const* bodies, int count, Twist* twists_B) noexcept {
  BodiesInLanes some(bodies, count);
  for (int i = 0; i < count; ++i) {
    setLane(some.lanes.momentum_W, i, bodies[i]->momentum_W);
    setLane(some.lanes.bodies.way_W, i, bodies[i]->way_W);
  }
  kFlightKernels.fastest()->carry(some.lanes);
  for (int i = 0; i < count; ++i) twists_B[i] = twistOf(some.lanes.bodies.twist_B, i);
}

}  // namespace ambient
