#pragma once

#include <cmath>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/motion/body/body_model.h"
#include "bullet_ambient/motion/flight/flight.h"
#include "bullet_ambient/spatial/rotation.h"
#include "tests/support/bodies/body_models.h"

namespace ambient::test {

using FreeBodyDef = BodyModelDef;

/// A body in free flight, outside of any world.
class FreeBody {
 public:
  explicit FreeBody(const FreeBodyDef& def) : model_(modelOf(def)) {}

  RigidState state;
  Surroundings surroundings;
  FlightSettings settings;
  FlightCount count;

  const BodyModel& model() const { return model_; }

  void setGravity(const Vector3& gravity) {
    surroundings.gravity = gravity;
    surroundings.applied.force = model_.mass * gravity;
  }
  void advance(double step, int steps = 1) {
    for (int i = 0; i < steps; ++i) {
      const FlightResult result = fly({model_, surroundings, settings, step}, state, memory_);
      state = result.state;
      memory_ = result.memory;
      count.substeps += result.count.substeps;
      count.load_evaluations += result.count.load_evaluations;
      count.guarded += result.count.guarded;
    }
  }
  /// Kinetic energy of body and fluid, in a fluid at rest [J].
  double kineticEnergy() const { return inertiaNormSquared(model_, state.twist.vector()) / 2; }
  /// Kinetic energy plus potential energy of weight and buoyancy [J].
  double totalEnergy() const {
    const Vector3 centre_of_volume = state.position + state.orientation * model_.centre_of_volume;
    return kineticEnergy() - surroundings.gravity.dot(model_.mass * state.position -
                                                      model_.displaced_mass * centre_of_volume);
  }
  /// Angular momentum about the origin of the world.
  Momentum worldMomentum() const {
    const Vector6 m_B = pairOfTwist(model_, state.twist.vector()).momentum;
    const Twist m = turned(state.orientation, Twist::fromVector(m_B));
    return {m.angular + state.position.cross(m.linear), m.linear};
  }

 private:
  BodyModel model_;
  FlightMemory memory_;
};

/// Fluid body of an added mass without faces: no loads but gravity and buoyancy.
inline FluidBody shapeWithoutFaces(const Matrix6& added_mass, double volume = 1) {
  FluidBody shape;
  shape.name = "inertia alone";
  shape.added_mass = added_mass;
  shape.volume = volume;
  shape.area = portable::pow(volume, 2.0 / 3.0);
  return shape;
}

struct Flow {
  RigidState state;        ///< at the end
  bool is_precise = true;  ///< false: large turn, cruder series used for the rest
};

/// Motion for `duration` [s] without loads, docs/theory.md eq. (22), up to `precision` relative to
/// the motion: one body of FlightKernel::drift.
inline Flow flowWithoutLoads(const FreeBody& body, double duration, double precision = 1e-16) {
  FlightLanes lanes{};
  setModel(lanes, 0, body.model());
  setState(lanes, 0, body.model(), body.state);
  lanes.has_diagonal_inertia = body.model().has_diagonal_inertia;
  lanes.active[0] = 1;
  lanes.drift_time[0] = duration;
  lanes.precision[0] = precision;
  kFlightKernels.fastest()->drift(lanes);
  return {stateOf(lanes, 0, body.state.position), !(lanes.is_coarse[0] > 0)};
}

}  // namespace ambient::test
