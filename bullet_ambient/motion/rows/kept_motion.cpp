#include "bullet_ambient/motion/rows/kept_motion.h"

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/motion/flight/flight_group.h"
#include "bullet_ambient/motion/lanes/row_lanes.h"

namespace ambient {
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
  fastestFlightKernel().keep(some.lanes);
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
  fastestFlightKernel().carry(some.lanes);
  for (int i = 0; i < count; ++i) twists_B[i] = twistOf(some.lanes.bodies.twist_B, i);
}

}  // namespace ambient
