#include "bullet_ambient/bullet/state/body_state.h"

#include <cmath>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/bullet/state/bullet_visitors.h"

AMBIENT_BEGIN
namespace {

// The mass whose rounded inverse is this one. setMassProps() takes no inverse.
btScalar massOfInverse(btScalar inverse_mass) {
  if (inverse_mass == 0) return 0;
  const btScalar mass = 1 / inverse_mass;
  btScalar below = mass, above = mass;
  for (int i = 0; i < 4; ++i) {
    if (1 / below == inverse_mass) return below;
    if (1 / above == inverse_mass) return above;
    below = std::nextafter(below, btScalar(0));
    above = std::nextafter(above, 2 * mass);
  }
  return mass;
}

bool isSame(const btVector3& a, const btVector3& b) {
  return a.x() == b.x() && a.y() == b.y() && a.z() == b.z();
}

// Bullet adds forces times factors; there is no setter.
void restoreForces(const BodyState& state, btRigidBody& body) {
  body.setLinearFactor(btVector3(1, 1, 1));
  body.setAngularFactor(btVector3(1, 1, 1));
  body.clearForces();
  body.applyCentralForce(state.total_force);
  body.applyTorque(state.total_torque);
  body.setLinearFactor(state.linear_factor);
  body.setAngularFactor(state.angular_factor);
}

}  // namespace

void restoreSleep(const ObjectState& s, btCollisionObject& object) {
  object.forceActivationState(s.activation_state);
  object.setDeactivationTime(s.deactivation_time);
}

void restoreMass(const BodyState& s, btRigidBody& body) {
  if (body.getInvMass() == s.inverse_mass &&
      isSame(body.getInvInertiaDiagLocal(), s.inverse_inertia) &&
      isSame(body.getGravity(), s.gravity)) {
    return;
  }
  body.setMassProps(massOfInverse(s.inverse_mass), btVector3(0, 0, 0));
  body.setInvInertiaDiagLocal(s.inverse_inertia);
  body.setGravity(s.gravity);
}

void restoreBody(const BodyState& s, btRigidBody& body) {
  AMBIENT_ASSERT(body.getInvMass() == s.inverse_mass);
  body.setCenterOfMassTransform(s.pose);  // its inertia follows
  toBullet(s, body);
  restoreForces(s, body);
}

AMBIENT_END
