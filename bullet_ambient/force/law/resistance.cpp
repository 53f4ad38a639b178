#include "bullet_ambient/force/law/resistance.h"

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
  const Wrench there = Wrench::fromVector(-scale.cwiseProduct(matrix * seen));
  return {there.torque + centre.cross(there.force), there.force};
}

}  // namespace ambient
