#include "bullet_ambient/bullet/core/attitude.h"

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/spatial/rotation.h"

AMBIENT_BEGIN
namespace {

constexpr double kMostTurn = kPi / 4;  // [rad] per step, Bullet's ANGULAR_MOTION_THRESHOLD
constexpr double kSine = 0.38268343236508977, kCosine = 0.92387953251128674;  // of its half

// Returns the sum of the squared differences of entries: twice the square of a small angle between
// the two attitudes [rad^2].
double squaredDifference(const btMatrix3x3& a, const btMatrix3x3& b) {
  double sum = 0;
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) {
      const auto difference = static_cast<double>(a[i][k] - b[i][k]);
      sum += difference * difference;
    }
  return sum;
}

}  // namespace

Quaternion turnedByBullet(const Quaternion& from, const Vector3& turn_W) noexcept {
  const double angle = turn_W.norm();
  if (!(angle > kMostTurn)) return rotationFromVector(turn_W) * from;
  // Bullet scales the axis by the angle, and the scalar part by its limit.
  const Vector3 axis = kSine / kMostTurn * turn_W;
  return Quaternion(kCosine, axis.x(), axis.y(), axis.z()).normalized() * from;
}

void settleAttitude(btRigidBody& body, const Quaternion& attitude) noexcept {
  const btTransform& now = body.getWorldTransform();
  const btMatrix3x3 basis(toBullet(attitude));
  const double difference = squaredDifference(now.getBasis(), basis);
  if (difference > 0 && difference <= 2 * kTurnRounding * kTurnRounding)
    body.setCenterOfMassTransform(btTransform(basis, now.getOrigin()));
}

AMBIENT_END
