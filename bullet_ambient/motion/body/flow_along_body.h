#pragma once

#include "bullet_ambient/force/law/passivity_guard.h"
#include "bullet_ambient/force/medium/pool_sides.h"
#include "bullet_ambient/spatial/spatial_vectors.h"

namespace ambient {

/// Motion of the fluid along a body beside its mean velocity, docs/theory.md eq. (85) to (87). Held
/// in the axes of the body over one step.
struct FlowAlongBody {
  static constexpr int kMost = 3;
  int stations = 0;       ///< 0: the fluid moves as one; 1: it turns; 3: it differs along an axis
  Twist twists_B[kMost];  ///< of the fluid at the stations, less its mean velocity
  Vector3 places_B[kMost]{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};  ///< of the stations [m]
  double weights[kMost]{};                                   ///< sum 1
  /// Load on a body that moves with the mean velocity. It acts as an applied wrench; loads that
  /// loadAlong() returns are less by it.
  Wrench at_rest_B;
  Vector3 spin_up_B{0, 0, 0};  ///< angular acceleration of the fluid along the body [rad/s^2]
  Wrench push_B;               ///< by the added mass that is spun up, eq. (88)
  Vector3 lean_W{0, 0, 0};  ///< what gravity is inclined by at a tilted surface, eq. (84) [m/s^2]
  PoolSides sides_F;        ///< sides of its pool that cut the body
  Wrench side_push_W;       ///< pressure of the water across them, eq. (90); world axes
  Wrench growth_W;          ///< of added mass that comes into the pool, eq. (91); world axes

  Wrench wrenchAtSides() const { return side_push_W + growth_W; }
  bool isNone() const {
    return stations == 0 && lean_W.isZero(0) && spin_up_B.isZero(0) && sides_F.count == 0;
  }
};

/// Returns the mean of a law over the stations of a body, less FlowAlongBody::at_rest_B.
/// `loadFor(x)`: SurfaceLoad for a twist relative to the fluid; `relative_twist`: relative to the
/// mean velocity. Where the fluid moves as one, returns loadFor(relative_twist).
template <class LoadFor>
SurfaceLoad loadAlong(const FlowAlongBody* flow, const Twist& relative_twist,
                      const LoadFor& loadFor) noexcept {
  if (!flow || flow->stations == 0) return loadFor(relative_twist);
  SurfaceLoad mean{};
  for (int i = 0; i < flow->stations; ++i) {
    const Twist& of_fluid = flow->twists_B[i];
    const SurfaceLoad load = loadFor(
        {relative_twist.angular - of_fluid.angular, relative_twist.linear - of_fluid.linear});
    mean.wrench += flow->weights[i] * load.wrench;
    mean.wrench.torque += flow->weights[i] * flow->places_B[i].cross(load.wrench.force);
    mean.guarded = mean.guarded || load.guarded;
  }
  mean.wrench -= flow->at_rest_B;
  return mean;
}

}  // namespace ambient
