#include "bullet_ambient/bullet/core/attitude.h"

#include "bullet_ambient/base/elementary.h"
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

Quaternion turnOfBullet(const Vector3& turn) noexcept {
  const double angle = turn.norm();
  if (!(angle > kMostTurn)) return rotationFromVector(turn);
  // Bullet scales the axis by the angle, and the scalar part by its limit.
  const Vector3 axis = kSine / kMostTurn * turn;
  return Quaternion(kCosine, axis.x(), axis.y(), axis.z()).normalized();
}

Quaternion turnedByBullet(const Quaternion& from, const Vector3& turn_W) noexcept {
  return turnOfBullet(turn_W) * from;
}

void settleAttitude(btRigidBody& body, const Quaternion& attitude) noexcept {
  const btTransform& now = body.getWorldTransform();
  const btMatrix3x3 basis(toBullet(attitude));
  const double difference = squaredDifference(now.getBasis(), basis);
  if (difference > 0 && difference <= 2 * kTurnRounding * kTurnRounding)
    body.setCenterOfMassTransform(btTransform(basis, now.getOrigin()));
}

btQuaternion turnAbout(const btVector3& axis, btScalar angle) noexcept {
  const double half = static_cast<double>(angle) / 2;
  const btVector3 way = axis * (static_cast<btScalar>(portable::sin(half)) / axis.length());
  return {way.x(), way.y(), way.z(), static_cast<btScalar>(portable::cos(half))};
}

bool settleLink(btMultibodyLink& link) noexcept {
  const bool is_planar = link.m_jointType == btMultibodyLink::ePlanar;
  if (!is_planar && link.m_jointType != btMultibodyLink::eRevolute) return false;
  const btScalar* position = link.m_jointPos;
  const btQuaternion turn = turnAbout(link.getAxisTop(0), -position[0]);
  const btQuaternion rotation = turn * link.m_zeroRotParentToThis;
  btVector3 way = quatRotate(rotation, link.m_eVector);
  if (is_planar) {
    way +=
        quatRotate(turn, position[1] * link.getAxisBottom(1) + position[2] * link.getAxisBottom(2));
  } else {
    way += link.m_dVector;
  }
  if (rotation == link.m_cachedRotParentToThis && way == link.m_cachedRVector) return false;
  link.m_cachedRotParentToThis = link.m_cachedRotParentToThis_interpolate = rotation;
  link.m_cachedRVector = link.m_cachedRVector_interpolate = way;
  return true;
}

AMBIENT_END
