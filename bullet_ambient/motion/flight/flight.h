#pragma once

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/instruction_set.h"
#include "bullet_ambient/motion/flight/flight_task.h"
#include "bullet_ambient/motion/lanes/flight_lanes.h"

namespace ambient {

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
/// Writes the resistance C of a body (null: none) where it has grown. @pre setModel()
void setResistance(BodyLanes& lanes, int body, const Resistance* resistance,
                   const Growth& growth) noexcept;
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
