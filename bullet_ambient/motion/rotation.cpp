#include "bullet_ambient/motion/rotation.h"

#include <cmath>

#include "bullet_ambient/motion/pose_kernel.h"

namespace ambient {

Quaternion rotationFromVector(const Vector3& r) {
  const double angle = r.norm();
  // sin(a/2)/a, whose series is exact to rounding where the quotient would lose digits.
  const double scale = angle < 1e-4 ? 0.5 - angle * angle / 48 : std::sin(angle / 2) / angle;
  const Vector3 v = scale * r;
  return Quaternion(std::cos(angle / 2), v.x(), v.y(), v.z()).normalized();
}

Vector3 rotationVector(const Quaternion& q) {
  const Vectors r = rotationVectors({{all(q.x()), all(q.y()), all(q.z())}, all(q.w())});
  return {r.x[0], r.y[0], r.z[0]};
}

}  // namespace ambient
