#include "bullet_ambient/force/law/passivity_guard.h"

#include <cmath>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/spatial/inertia.h"

namespace ambient {

SurfaceLoad removePositivePower(const Wrench& surface_wrench, const Twist& relative_twist,
                                const Matrix6& inertia) noexcept {
  // F' depends only on the direction of x. Scaling x to 1 avoids overflow and underflow.
  const Vector6 twist = relative_twist.vector();
  AMBIENT_ASSERT(isSymmetric(inertia, 1e-9));
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
