#include "bullet_ambient/bullet/ambient_impulse.h"

#include "bullet_ambient/bullet/ambient_bodies.h"
#include "bullet_ambient/motion/axis_locks.h"

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {
namespace {

// The attached body if a fluid answers to impulses, else null.
const AmbientBody* findInFluid(AmbientRegistry& registry, const btRigidBody& body) {
  AmbientBody* ambient = bodiesOf(registry).find(&body);
  if (!ambient || !ambient->isInFluid() || body.isStaticOrKinematicObject()) return nullptr;
  if (isModelStale(*ambient)) rebuildModel(*ambient);
  return ambient;
}

// Response of the velocity to a wrench impulse, world axes.
Matrix6 inverseInertia(const AmbientBody& ambient) {
  const btRigidBody& body = *ambient.body;
  const Matrix3 R = readState(body).orientation.toRotationMatrix();
  const AxisFactors factors = axisFactors(body);
  const BodyModel model = modelNow(ambient);
  if (factors.areFree()) return rotateAxes(model.inverse_inertia, R);
  return lockedInverse(rotateAxes(model.inertia, R), factors);
}

void applyWrenchImpulse(const AmbientBody& ambient, btRigidBody& body, const Wrench& impulse) {
  const Twist change = Twist::fromVector(inverseInertia(ambient) * impulse.vector());
  body.setAngularVelocity(body.getAngularVelocity() + toBullet(change.angular));
  body.setLinearVelocity(body.getLinearVelocity() + toBullet(change.linear));
  body.activate();
}

// Stock: each axis scaled by its factor, as applyImpulse() has it.
btMatrix3x3 dryInverseMass(const btRigidBody& body, const btVector3& r) {
  btMatrix3x3 result;
  for (int axis = 0; axis < 3; ++axis) {
    btVector3 impulse(0, 0, 0);
    impulse[axis] = body.getLinearFactor()[axis];
    const btVector3 spin =
        body.getInvInertiaTensorWorld() * r.cross(impulse) * body.getAngularFactor();
    const btVector3 change = impulse * body.getInvMass() + spin.cross(r);
    for (int row = 0; row < 3; ++row) result[row][axis] = change[row];
  }
  return result;
}

}  // namespace

void applyAmbientImpulse(AmbientRegistry& registry, btRigidBody& body, const btVector3& impulse,
                         const btVector3& relative_position) {
  const AmbientBody* ambient = findInFluid(registry, body);
  if (!ambient) return body.applyImpulse(impulse, relative_position);
  applyWrenchImpulse(*ambient, body,
                     Wrench::ofForceAt(toVector3(impulse), toVector3(relative_position)));
}

void applyAmbientTorqueImpulse(AmbientRegistry& registry, btRigidBody& body,
                               const btVector3& torque_impulse) {
  const AmbientBody* ambient = findInFluid(registry, body);
  if (!ambient) return body.applyTorqueImpulse(torque_impulse);
  applyWrenchImpulse(*ambient, body, {toVector3(torque_impulse), Vector3::Zero()});
}

btMatrix3x3 inverseEffectiveMass(AmbientRegistry& registry, const btRigidBody& body,
                                 const btVector3& relative_position) {
  const AmbientBody* ambient = findInFluid(registry, body);
  if (!ambient) return dryInverseMass(body, relative_position);
  const Matrix6 response = inverseInertia(*ambient);
  const Matrix3 r = crossMatrix(toVector3(relative_position));
  // J^T K^-1 J with the wrench J f = (r x f, f) of an impulse f.
  Matrix3 result = response.bottomRightCorner<3, 3>() + response.bottomLeftCorner<3, 3>() * r -
                   r * response.topRightCorner<3, 3>() - r * response.topLeftCorner<3, 3>() * r;
  result = 0.5 * (result + result.transpose()).eval();
  return toBulletMatrix(result);
}

btScalar inverseEffectiveMass(AmbientRegistry& registry, const btRigidBody& body,
                              const btVector3& relative_position, const btVector3& direction) {
  return direction.dot(inverseEffectiveMass(registry, body, relative_position) * direction);
}

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
