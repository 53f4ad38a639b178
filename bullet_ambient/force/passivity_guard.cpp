#include "bullet_ambient/force/passivity_guard.h"

#include <cmath>

#include "bullet_ambient/spatial/ambient_assert.h"

namespace ambient {

SurfaceLoad removePositivePower(const Wrench& surface_wrench, const Twist& relative_twist,
                                const Matrix6& inertia) noexcept {
  // F' depends on the direction of x alone; without its size nothing over- or underflows.
  const Vector6 twist = relative_twist.vector();
  const double largest = twist.cwiseAbs().maxCoeff();
  if (!(largest > 0) || !std::isfinite(largest)) return {surface_wrench, false};
  const Vector6 x = twist / largest;
  const Vector6 f = surface_wrench.vector();
  const double gained = f.dot(x);
  if (!(gained > 0) || !std::isfinite(gained)) return {surface_wrench, false};
  const Vector6 momentum = inertia * x;
  AMBIENT_ASSERT(x.dot(momentum) > 0);
  return {Wrench::fromVector(f - gained / x.dot(momentum) * momentum), true};
}

}  // namespace ambient
