#include "bullet_ambient/spatial/rotation.h"

#include <cmath>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"

namespace ambient {
namespace {

// A number of each of two vectors, in one register.
using Pair __attribute__((vector_size(16))) = double;
struct VectorPair {
  Pair x, y, z;
};

VectorPair cross(const Vector3& a, const VectorPair& b) {
  return {a.y() * b.z - a.z() * b.y, a.z() * b.x - a.x() * b.z, a.x() * b.y - a.y() * b.x};
}

}  // namespace

Twist turned(const Quaternion& q, const Twist& x) {
  const VectorPair v{
      {x.angular.x(), x.linear.x()}, {x.angular.y(), x.linear.y()}, {x.angular.z(), x.linear.z()}};
  const Vector3 u = q.vec();
  VectorPair t = cross(u, v);
  t = {t.x + t.x, t.y + t.y, t.z + t.z};
  const VectorPair s = cross(u, t);
  const double w = q.w();
  const Pair a = v.x + w * t.x + s.x, b = v.y + w * t.y + s.y, c = v.z + w * t.z + s.z;
  return {{a[0], b[0], c[0]}, {a[1], b[1], c[1]}};
}

Quaternion rotationFromVector(const Vector3& r) {
  const double angle = r.norm();
  // sin(a/2)/a; for small angles by its series, because the quotient would lose digits.
  const auto [sine, cosine] = portable::sineAndCosine(angle / 2);
  const double scale = angle < 1e-4 ? 0.5 - angle * angle / 48 : sine / angle;
  const Vector3 v = scale * r;
  return Quaternion(cosine, v.x(), v.y(), v.z()).normalized();
}

Vector3 rotationVector(const Quaternion& q) {
  constexpr double kTiny = 1e-150;  // the square of kTiny does not underflow
  const double sine = q.vec().norm();
  const double ratio = sine > kTiny ? portable::atan2(sine, std::abs(q.w())) / sine : 1;
  return (q.w() < 0 ? -2 * ratio : 2 * ratio) * q.vec();
}

bool isTurnedFurther(const Quaternion& a, const Quaternion& b, double limit) {
  const Quaternion turn = a.conjugate() * b;
  // An angle is at most pi times the sine of its half.
  if (kPi * turn.vec().norm() * (1 + 1e-12) <= limit) return false;
  return rotationVector(turn).norm() > limit;
}

}  // namespace ambient
