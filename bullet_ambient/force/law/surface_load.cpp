#include "bullet_ambient/force/law/surface_load.h"

#include <cmath>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/spatial/inertia.h"

namespace ambient {

Matrix6 Resistance::grown(const Growth& growth) const noexcept {
  const Vector6 scale =
      stack(Vector3::Constant(growth.rotation), Vector3::Constant(growth.translation));
  const Matrix6 at_centre = scale.asDiagonal() * matrix * scale.asDiagonal();
  if (centre.isZero(0)) return at_centre;
  return shiftOrigin(at_centre, -centre);
}

Wrench Resistance::load(const Growth& growth, const Twist& x) const noexcept {
  const Vector6 scale =
      stack(Vector3::Constant(growth.rotation), Vector3::Constant(growth.translation));
  const Vector6 seen = scale.cwiseProduct(stack(x.angular, x.at(centre)));
  return Wrench::fromVector(-scale.cwiseProduct(matrix * seen)).aboutOrigin(centre);
}

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
