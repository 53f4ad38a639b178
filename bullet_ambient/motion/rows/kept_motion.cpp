#include "bullet_ambient/motion/rows/kept_motion.h"

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/motion/flight/flight_group.h"
#include "bullet_ambient/motion/lanes/row_lanes.h"

namespace ambient {
namespace {

// Lanes of a number of bodies, with their models and orientations.
template <class Body>
class Rows {
 public:
  Rows(const Body* const* bodies, int count) {
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
  Rows rows(bodies, count);
  for (int i = 0; i < count; ++i) {
    rows.lanes.bodies.kick_time[i] = duration;
    setLane(rows.lanes.velocity_W, i, bodies[i]->velocity_W);
    setLane(rows.lanes.turning_W, i, bodies[i]->turning_W);
    setLane(rows.lanes.by_rows_W, i, bodies[i]->by_rows_W);
  }
  fastestFlightKernel().keep(rows.lanes);
  for (int i = 0; i < count; ++i) {
    const FlightLane* m = rows.lanes.momentum_W;
    results[i] = {
        {vectorOf(m, i), vectorOf(m + 3, i)}, rows.lanes.extent[i], rows.lanes.twice_energy[i]};
  }
}

void computeCarriedTwists(const CarriedBody* const* bodies, int count, Twist* twists_B) noexcept {
  Rows rows(bodies, count);
  for (int i = 0; i < count; ++i) {
    setLane(rows.lanes.momentum_W, i, bodies[i]->momentum_W);
    setLane(rows.lanes.bodies.way_W, i, bodies[i]->way_W);
  }
  fastestFlightKernel().carry(rows.lanes);
  for (int i = 0; i < count; ++i) twists_B[i] = twistOf(rows.lanes.bodies.twist_B, i);
}

}  // namespace ambient
