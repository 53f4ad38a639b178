#include "bullet_ambient/motion/kirchhoff_flow.h"

#include "bullet_ambient/motion/flight_group.h"

namespace ambient {

Flow flowWithoutLoads(const BodyModel& model, const RigidState& state, double duration,
                      double precision) noexcept {
  FlightLanes lanes{};
  setModel(lanes, 0, model);
  setState(lanes, 0, model, state);
  lanes.has_diagonal_inertia = model.has_diagonal_inertia;
  lanes.active[0] = 1;
  lanes.flow_time[0] = duration;
  lanes.precision[0] = precision;
  fastestFlightKernel().flow(lanes);
  return {stateOf(lanes, 0, state.position), !(lanes.is_coarse[0] > 0)};
}

}  // namespace ambient
