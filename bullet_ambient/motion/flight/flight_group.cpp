#include "bullet_ambient/motion/flight/flight_group.h"

#include <cmath>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/spatial/inertia.h"

namespace ambient {
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

void setResistance(BodyLanes& lanes, int body, const Resistance* resistance,
                   const Growth& growth) noexcept {
  if (!lanes.has_resistance) return;
  const bool is_viscous = resistance && growth.translation > 0;
  lanes.is_viscous[body] = is_viscous ? 1 : 0;
  if (lanes.has_diagonal_inertia) {
    const double roots[2] = {growth.rotation, growth.translation};
    for (int i = 0; i < 6; ++i)
      lanes.resistance[symmetricEntry(i, i)][body] =
          is_viscous ? resistance->matrix(i, i) * roots[i / 3] * roots[i / 3] : 0;
    return;
  }
  setSymmetric(lanes.resistance, body,
               is_viscous ? resistance->grown(growth) : Matrix6(Matrix6::Zero()), false);
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
  lanes.fall_scale[body] = fallScale(task);
}

void setState(FlightLanes& lanes, int body, const BodyModel& model,
              const RigidState& state) noexcept {
  // Written so that NaN passes: the flight of a state that is not finite is rejected later.
  AMBIENT_ASSERT(!(std::abs(state.orientation.squaredNorm() - 1) > 1e-6));
  setLane(lanes.orientation, body, state.orientation);
  setLane(lanes.way_W, body, Vector3(0, 0, 0));
  const DualPair motion = pairOfTwist(model, state.twist.vector());
  for (int i = 0; i < 6; ++i) {
    lanes.twist_B[i][body] = motion.twist[i];
    lanes.momentum_B[i][body] = motion.momentum[i];
  }
}

RigidState stateOf(const FlightLanes& lanes, int body, const Vector3& start) noexcept {
  return {orientationOf(lanes.orientation, body), start + vectorOf(lanes.way_W, body),
          twistOf(lanes.twist_B, body)};
}

}  // namespace ambient
