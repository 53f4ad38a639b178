#include "bullet_ambient/bullet/links/tree_now.h"
#include "bullet_ambient/bullet/members/ambient_bodies.h"
#include "bullet_ambient/fluid.h"
#include "bullet_ambient/impulse.h"

AMBIENT_BEGIN
namespace {

// The body if a fluid answers to impulses, else null.
AmbientBody* findInFluid(const Fluid& fluid, const btRigidBody& body) {
  AmbientBody* ambient = membersOf(fluid).find(&body);
  return ambient && ambient->isInFluid() && !body.isStaticOrKinematicObject() ? ambient : nullptr;
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

void applyAmbientImpulse(Fluid& fluid, btRigidBody& body, const btVector3& impulse,
                         const btVector3& relative_position) {
  AmbientBody* ambient = findInFluid(fluid, body);
  if (!ambient) return body.applyImpulse(impulse, relative_position);
  applyImpulseToBody(*ambient, Wrench::ofForceAt(toVector3(impulse), toVector3(relative_position)));
  body.activate();
}

void applyAmbientTorqueImpulse(Fluid& fluid, btRigidBody& body, const btVector3& torque_impulse) {
  AmbientBody* ambient = findInFluid(fluid, body);
  if (!ambient) return body.applyTorqueImpulse(torque_impulse);
  applyImpulseToBody(*ambient, {toVector3(torque_impulse), Vector3::Zero()});
  body.activate();
}

btMatrix3x3 inverseEffectiveMass(const Fluid& fluid, const btRigidBody& body,
                                 const btVector3& relative_position) {
  AmbientBody* ambient = findInFluid(fluid, body);
  if (!ambient) return dryInverseMass(body, relative_position);
  const Matrix6 response = inverseInertia(*ambient);
  const Matrix3 r = crossMatrix(toVector3(relative_position));
  // J^T K^-1 J with the wrench J f = (r x f, f) of an impulse f.
  Matrix3 result = response.bottomRightCorner<3, 3>() + response.bottomLeftCorner<3, 3>() * r -
                   r * response.topRightCorner<3, 3>() - r * response.topLeftCorner<3, 3>() * r;
  result = 0.5 * (result + result.transpose()).eval();
  return toBulletMatrix(result);
}

btScalar inverseEffectiveMass(const Fluid& fluid, const btRigidBody& body,
                              const btVector3& relative_position, const btVector3& direction) {
  return direction.dot(inverseEffectiveMass(fluid, body, relative_position) * direction);
}

AMBIENT_END
