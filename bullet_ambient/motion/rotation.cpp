#include "bullet_ambient/motion/rotation.h"

#include <cmath>

namespace ambient {

Quaternion rotationFromVector(const Vector3& r) {
  const double angle = r.norm();
  // sin(a/2)/a, whose series is exact to rounding where the quotient would lose digits.
  const double scale = angle < 1e-4 ? 0.5 - angle * angle / 48 : std::sin(angle / 2) / angle;
  const Vector3 v = scale * r;
  return Quaternion(std::cos(angle / 2), v.x(), v.y(), v.z()).normalized();
}

Vector3 rotationVector(const Quaternion& q) {
  const double sine_sq = q.vec().squaredNorm();
  const double sign = q.w() < 0 ? -1 : 1;
  // Below 1.7 degrees, asin(s)/s by its series: the next term is below rounding.
  if (sine_sq < 2.25e-4) {
    const double s = sine_sq;
    return sign * (2 + s * (1.0 / 3 + s * (3.0 / 20 + s * (5.0 / 56 + s * (35.0 / 576))))) *
           q.vec();
  }
  const double sine = std::sqrt(sine_sq);
  const double cosine = std::abs(q.w());
  const double half_angle = std::atan2(sine, cosine);
  return sign * 2 * half_angle / sine * q.vec();
}

}  // namespace ambient
