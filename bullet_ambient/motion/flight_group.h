#pragma once

#include "bullet_ambient/motion/flight.h"
#include "bullet_ambient/motion/flight_lanes.h"
#include "bullet_ambient/spatial/ambient_assert.h"
#include "bullet_ambient/spatial/instruction_set.h"

namespace ambient {

constexpr Kernels<const FlightKernel*> kFlightKernels{&kFlightKernelBaseline, &kFlightKernelAvx2,
                                                      &kFlightKernelAvx512};

/// The best kernel for this processor.
const FlightKernel& fastestFlightKernel() noexcept;

/// Writes one body into its lane; lanes of no body are zero, FlightLanes{}.
void setModel(FlightLanes& lanes, int body, const BodyModel& model) noexcept;
void setSurroundings(FlightLanes& lanes, int body, const FlightTask& task) noexcept;
/// Its total inertia in B and the inverse.
void setInertia(FlightLanes& lanes, int body, const Matrix6& inertia, const Matrix6& inverse,
                bool is_diagonal) noexcept;
/// Its twist relative to the frame that moves with the ambient flow, in B.
void setState(FlightLanes& lanes, int body, const BodyModel& model,
              const RigidState& state) noexcept;
/// `start`: the position at which it was set.
RigidState stateOf(const FlightLanes& lanes, int body, const Vector3& start) noexcept;

/// Values of one body.
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
