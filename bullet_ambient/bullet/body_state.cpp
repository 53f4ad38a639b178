#include "bullet_ambient/bullet/body_state.h"

#include <cmath>

#include "bullet_ambient/spatial/ambient_assert.h"

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {
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

BodyState saveBody(const btRigidBody& body) {
  BodyState s;
  s.pose = body.getWorldTransform();
  s.interpolation_pose = body.getInterpolationWorldTransform();
  s.linear_velocity = body.getLinearVelocity();
  s.angular_velocity = body.getAngularVelocity();
  s.interpolation_linear_velocity = body.getInterpolationLinearVelocity();
  s.interpolation_angular_velocity = body.getInterpolationAngularVelocity();
  s.total_force = body.getTotalForce();
  s.total_torque = body.getTotalTorque();
  s.gravity = body.getGravity();
  s.inverse_inertia = body.getInvInertiaDiagLocal();
  s.linear_factor = body.getLinearFactor();
  s.angular_factor = body.getAngularFactor();
  s.inverse_mass = body.getInvMass();
  s.linear_damping = body.getLinearDamping();
  s.angular_damping = body.getAngularDamping();
  s.linear_sleeping_threshold = body.getLinearSleepingThreshold();
  s.angular_sleeping_threshold = body.getAngularSleepingThreshold();
  s.friction = body.getFriction();
  s.rolling_friction = body.getRollingFriction();
  s.spinning_friction = body.getSpinningFriction();
  s.restitution = body.getRestitution();
  s.ccd_radius = body.getCcdSweptSphereRadius();
  s.ccd_threshold = body.getCcdMotionThreshold();
  s.contact_processing_threshold = body.getContactProcessingThreshold();
  s.deactivation_time = body.getDeactivationTime();
  s.activation_state = body.getActivationState();
  s.collision_flags = body.getCollisionFlags();
  s.flags = body.getFlags();
  return s;
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
  body.setCollisionFlags(s.collision_flags);
  body.setFlags(s.flags);
  body.setCenterOfMassTransform(s.pose);
  body.setInterpolationWorldTransform(s.interpolation_pose);
  body.setLinearVelocity(s.linear_velocity);
  body.setAngularVelocity(s.angular_velocity);
  body.setInterpolationLinearVelocity(s.interpolation_linear_velocity);
  body.setInterpolationAngularVelocity(s.interpolation_angular_velocity);
  restoreForces(s, body);
  body.setDamping(s.linear_damping, s.angular_damping);
  body.setSleepingThresholds(s.linear_sleeping_threshold, s.angular_sleeping_threshold);
  body.setFriction(s.friction);
  body.setRollingFriction(s.rolling_friction);
  body.setSpinningFriction(s.spinning_friction);
  body.setRestitution(s.restitution);
  body.setCcdSweptSphereRadius(s.ccd_radius);
  body.setCcdMotionThreshold(s.ccd_threshold);
  body.setContactProcessingThreshold(s.contact_processing_threshold);
}

void restoreSleep(const BodyState& s, btRigidBody& body) {
  body.forceActivationState(s.activation_state);
  body.setDeactivationTime(s.deactivation_time);
}

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
