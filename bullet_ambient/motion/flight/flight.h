#pragma once

#include <algorithm>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/instruction_set.h"
#include "bullet_ambient/motion/body/body_model.h"
#include "bullet_ambient/motion/flight/flight_settings.h"
#include "bullet_ambient/motion/lanes/flight_lanes.h"
#include "bullet_ambient/spatial/spatial_vectors.h"

namespace ambient {

/// Memory of the leapfrog from one step to the next. Reset if other code has changed the
/// velocity.
struct FlightMemory {
  Wrench load_W;  ///< last surface load, world axes
  Growth growth;  ///< of the resistance then
  bool has_load = false;
  double substep = 0;  ///< substep to try first in the next step [s]; 0: unknown
};

/// Forces and flow that act on a body in one step besides surface loads, and the share of these.
/// World axes; constant over the step.
struct Surroundings {
  Vector3 gravity = Vector3::Zero();  ///< gravity of the hydrostatic pressure only [m/s^2]
  Wrench applied;  ///< all other forces, weight included; torque about the centre of mass
  Vector3 ambient_velocity = Vector3::Zero();      ///< at the start of the step [m/s]
  Vector3 ambient_acceleration = Vector3::Zero();  ///< [m/s^2]
  double load_scale = 1;  ///< factor on the surface loads, docs/theory.md eq. (51d)
  /// How the fluid moves along the body besides; null: as one.
  const FlowAlongBody* flow = nullptr;

  /// True if a torque is applied whose work no energy of place has.
  bool hasTorque() const noexcept {
    return applied.torque != (flow ? flow->wrenchAtSides().torque : Vector3(Vector3::Zero()));
  }
};

/// Computes the surface load of a body in its surroundings.
inline SurfaceLoad computeSurfaceLoad(const BodyModel& model, const Twist& relative_twist,
                                      const Surroundings& s) noexcept {
  return computeSurfaceLoad(model, relative_twist, s.load_scale, s.flow);
}

struct FlightCount {
  int substeps = 0;
  int load_evaluations = 0;
  int guarded = 0;  ///< evaluations in which the passivity guard acted
  /// True if substeps or retries ran out with the error above the tolerance.
  bool coarse = false;
  double error = 0;  ///< velocity error of a coarse step, relative to the motion; 1: not known
  /// True if the motion stopped before the end of the step, because no substep keeps the energy,
  /// docs/theory.md eq. (64).
  bool halted = false;
  double energy_removed = 0;  ///< energy removed by the bounds of eq. (22), (25a), (64), (68) [J]

  /// Adds what another part of the step has cost.
  FlightCount& operator+=(const FlightCount& part) noexcept {
    substeps += part.substeps;
    load_evaluations += part.load_evaluations;
    guarded += part.guarded;
    coarse = coarse || part.coarse;
    error = std::max(error, part.error);
    halted = halted || part.halted;
    energy_removed += part.energy_removed;
    return *this;
  }
};

struct FlightResult {
  RigidState state;  ///< twist absolute, in B
  FlightMemory memory;
  FlightCount count;
};

/// Weight, buoyancy and inertial forces of the ambient acceleration in B, docs/theory.md eq. (18)
/// and (19), for the orientation R, B to W.
Wrench externalWrench(const BodyModel& model, const Surroundings& surroundings, const Matrix3& R);

/// One body over one step.
struct FlightTask {
  const BodyModel& model;
  const Surroundings& surroundings;
  const FlightSettings& settings;
  double duration;  ///< [s], > 0
  /// Precision of the motion without loads, relative to it: below the rounding of the numbers that
  /// keep poses and velocities between steps.
  double precision = 1e-16;
};

/// Norm in the metric of K of the motion after a fall by the body's own size [sqrt(J)]: second
/// term in the denominator of docs/theory.md eq. (25), which relates velocity errors to the
/// motion.
double velocityScale(const FlightTask& task);

/// Number of substeps of at most a length [s]; 0: it is not known, one.
int substepsFor(double duration, double substep, int most) noexcept;

/// Conversions to the frame that moves with the ambient flow, and after a time t [s] back to W.
void enterFrame(const Surroundings& s, RigidState& state) noexcept;
void leaveFrame(const Surroundings& s, double t, RigidState& state) noexcept;

/// Computes the potential energy of docs/theory.md eq. (64) without T: `of_water`, energy of
/// surface and waves, minus the work of constant forces on the way [J].
/// `pose`: B in axes of W, and the displacement of the centre of mass since the motion began, in a
/// frame that moves with the fluid.
double potentialEnergy(const BodyModel& model, const Surroundings& surroundings,
                       const FrameOffset& pose, double of_water);

/// Task and state of a body: start state before flyTogether(), end state afterwards.
struct Flight {
  Flight(const FlightTask& given, const RigidState& start, const FlightMemory& memory)
      : task(given), body{start, memory, {}} {}

  FlightTask task;
  FlightResult body;
};

/// Number of bodies that flyTogether() moves side by side.
constexpr int kFlightsTogether = 8;

/// Integrates Kirchhoff's equations with loads over the task's duration. `start`: pose in W, twist
/// absolute, in B. Works in the frame that moves with the ambient flow. Allocates nothing. The
/// result is not finite if the input or a load is not: check before use.
FlightResult fly(const FlightTask& task, const RigidState& start,
                 const FlightMemory& memory) noexcept;

/// Like fly(), for several bodies, with the same bits; results replace the input in Flight::body.
/// With the passive leapfrog kFlightsTogether bodies cost little more than one, loads excepted.
void flyTogether(Flight* const* flights, int count) noexcept;

/// Passive leapfrog with bounded adaptive substeps, docs/theory.md eq. (22) to (25), for each of up
/// to kFlightsTogether bodies. States are relative to the frame that moves with the ambient flow.
void flyLeapfrog(Flight* const* flights, int count) noexcept;

extern const Kernels<const FlightKernel*> kFlightKernels;

/// Sets what the models of all bodies have in common, before setModel(). `modelOf(i)`: model of
/// body i.
template <class ModelOf>
void setKinds(BodyLanes& lanes, int count, const ModelOf& modelOf) noexcept {
  lanes.has_diagonal_inertia = true;
  lanes.has_loads = lanes.has_resistance = false;
  for (int i = 0; i < count; ++i) {
    const BodyModel& model = modelOf(i);
    lanes.has_diagonal_inertia = lanes.has_diagonal_inertia && model.has_diagonal_inertia;
    lanes.has_loads = lanes.has_loads || model.loads;
    lanes.has_resistance = lanes.has_resistance || model.resistance;
  }
}

/// Writes the model of a body into lane `body`: with has_diagonal_inertia of the lanes, only the
/// diagonals of K and K^-1. Lanes without a body stay 0, as in BodyLanes{}.
void setModel(BodyLanes& lanes, int body, const BodyModel& model) noexcept;
/// Writes the resistance of a body; null: none. @pre setKinds()
void setResistance(BodyLanes& lanes, int body, const Resistance* resistance) noexcept;
/// Writes how much it has grown; zero: it does not act.
void setGrowth(BodyLanes& lanes, int body, const Growth& growth) noexcept;
/// Writes the wrench on a body without surface loads.
void setForces(BodyLanes& lanes, int body, const FlightTask& task) noexcept;
/// Writes that wrench, and the scale of its errors.
void setSurroundings(FlightLanes& lanes, int body, const FlightTask& task) noexcept;
/// Writes pose and twist of a body; twist in B, relative to the frame that moves with the flow.
void setState(FlightLanes& lanes, int body, const BodyModel& model,
              const RigidState& state) noexcept;
/// Reads the state of a body; `start`: position in W at setState() [m].
RigidState stateOf(const FlightLanes& lanes, int body, const Vector3& start) noexcept;

/// Access to the values of one body.
inline void setLane(FlightLane* to, int body, const Vector3& a) noexcept {
  AMBIENT_ASSERT(body >= 0 && body < kFlightLanes);
  for (int i = 0; i < 3; ++i) to[i][body] = a[i];
}
inline void setLane(FlightLane* to, int body, const Wrench& f) noexcept {
  setLane(to, body, f.torque);
  setLane(to + 3, body, f.force);
}
inline void setLane(FlightLane* to, int body, const Twist& x) noexcept {
  setLane(to, body, x.angular);
  setLane(to + 3, body, x.linear);
}
inline void setLane(FlightLane* to, int body, const Momentum& m) noexcept {
  setLane(to, body, m.angular);
  setLane(to + 3, body, m.linear);
}
inline void setLane(FlightLane* to, int body, const Quaternion& q) noexcept {
  for (int i = 0; i < 4; ++i) to[i][body] = q.coeffs()[i];
}
inline Vector3 vectorOf(const FlightLane* from, int body) noexcept {
  return {from[0][body], from[1][body], from[2][body]};
}
inline Wrench wrenchOf(const FlightLane* from, int body) noexcept {
  return {vectorOf(from, body), vectorOf(from + 3, body)};
}
inline Twist twistOf(const FlightLane* from, int body) noexcept {
  return {vectorOf(from, body), vectorOf(from + 3, body)};
}
inline Quaternion orientationOf(const FlightLane* from, int body) noexcept {
  return {from[3][body], from[0][body], from[1][body], from[2][body]};
}

}  // namespace ambient
