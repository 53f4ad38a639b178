#include "bullet_ambient/bullet/core/body_motion.h"

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/spatial/rotation.h"

AMBIENT_BEGIN
namespace {

RigidState stateOf(const btTransform& pose, const Twist& twist_W) {
  RigidState state;
  state.orientation = toQuaternion(pose.getRotation());
  state.position = toVector3(pose.getOrigin());
  state.twist = turned(state.orientation.conjugate(), twist_W);
  return state;
}

}  // namespace

RigidState readState(const btRigidBody& body) {
  return stateOf(body.getWorldTransform(), velocityOf(body));
}

AxisFactors axisFactors(const btRigidBody& body) {
  return {toVector3(body.getAngularFactor()), toVector3(body.getLinearFactor())};
}

void setMotion(const btTransform& pose, const Twist& twist_W, MotionView& view) {
  view.state = stateOf(pose, twist_W);
  view.twist_W = twist_W;
  view.rounding = kBulletRounding;
}

MotionView motionOf(const btRigidBody& body) {
  MotionView view;
  setMotion(body.getWorldTransform(), velocityOf(body), view);
  view.gravity = toVector3(body.getGravity());
  return view;
}

Surroundings readSurroundings(const AmbientBody& ambient) {
  const btRigidBody& body = *ambient.body;
  Surroundings surroundings =
      surroundingsOf(ambient, toVector3(body.getGravity()),
                     {toVector3(body.getTotalTorque()), toVector3(body.getTotalForce())});
  if (hasFlowAlong(ambient))
    addFlowAlong(ambient, toQuaternion(body.getWorldTransform().getRotation()), surroundings);
  return surroundings;
}

namespace {

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

btQuaternion turnInStep(const btVector3& spin, btScalar h) noexcept {
  constexpr btScalar kMost = btScalar(0.5) * SIMD_HALF_PI, kSlow = btScalar(0.001);
  btScalar speed = spin.length();
  if (speed * h > kMost) speed = kMost / h;
  const auto [sine, cosine] =
      portable::sineAndCosine(static_cast<double>(btScalar(0.5) * speed * h));
  const btScalar series = btScalar(0.5) * h - h * h * h * btScalar(0.020833333333) * speed * speed;
  const btVector3 axis = spin * (speed < kSlow ? series : static_cast<btScalar>(sine) / speed);
  return {axis.x(), axis.y(), axis.z(), static_cast<btScalar>(cosine)};
}

btQuaternion turnAbout(const btVector3& axis, btScalar angle) noexcept {
  const auto [sine, cosine] = portable::sineAndCosine(static_cast<double>(angle) / 2);
  const btVector3 scaled = axis * (static_cast<btScalar>(sine) / axis.length());
  return {scaled.x(), scaled.y(), scaled.z(), static_cast<btScalar>(cosine)};
}

bool settleLink(btMultibodyLink& link) noexcept {
  const bool is_planar = link.m_jointType == btMultibodyLink::ePlanar;
  if (!is_planar && link.m_jointType != btMultibodyLink::eRevolute) return false;
  const btScalar* position = link.m_jointPos;
  const btQuaternion turn = turnAbout(link.getAxisTop(0), -position[0]);
  const btQuaternion rotation = turn * link.m_zeroRotParentToThis;
  if (!is_planar && rotation == link.m_cachedRotParentToThis) return false;
  btVector3 offset = quatRotate(rotation, link.m_eVector);
  if (is_planar) {
    offset +=
        quatRotate(turn, position[1] * link.getAxisBottom(1) + position[2] * link.getAxisBottom(2));
  } else {
    offset += link.m_dVector;
  }
  if (rotation == link.m_cachedRotParentToThis && offset == link.m_cachedRVector) return false;
  link.m_cachedRotParentToThis = link.m_cachedRotParentToThis_interpolate = rotation;
  link.m_cachedRVector = link.m_cachedRVector_interpolate = offset;
  return true;
}

AMBIENT_END
