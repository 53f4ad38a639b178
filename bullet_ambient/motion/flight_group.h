#pragma once

#include "bullet_ambient/force/face_sums.h"
#include "bullet_ambient/motion/flight.h"
#include "bullet_ambient/motion/flight_lanes.h"

namespace ambient {

/// The kernel for an instruction set; null if this processor does not have it.
const FlightKernel* flightKernelFor(InstructionSet instruction_set) noexcept;

/// The best kernel for this processor.
const FlightKernel& fastestFlightKernel() noexcept;

/// Writes one body into its lane; lanes of no body are zero, FlightLanes{}.
void setModel(FlightLanes& lanes, int body, const BodyModel& model) noexcept;
void setSurroundings(FlightLanes& lanes, int body, const FlightTask& task) noexcept;
/// Its twist relative to the frame that moves with the ambient flow, in B.
void setState(FlightLanes& lanes, int body, const BodyModel& model,
              const RigidState& state) noexcept;
RigidState stateOf(const FlightLanes& lanes, int body) noexcept;

/// Three or six values of one body.
inline void set(FlightLane* to, int body, const Vector3& a) noexcept {
  for (int i = 0; i < 3; ++i) to[i][body] = a[i];
}
inline Vector3 vectorOf(const FlightLane* from, int body) noexcept {
  return {from[0][body], from[1][body], from[2][body]};
}
inline void set(FlightLane* to, int body, const Wrench& f) noexcept {
  set(to, body, f.torque);
  set(to + 3, body, f.force);
}
inline Wrench wrenchOf(const FlightLane* from, int body) noexcept {
  return {vectorOf(from, body), vectorOf(from + 3, body)};
}
inline Twist twistOf(const FlightLane* from, int body) noexcept {
  return {vectorOf(from, body), vectorOf(from + 3, body)};
}

}  // namespace ambient
