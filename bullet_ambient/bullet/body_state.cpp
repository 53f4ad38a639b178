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

ObjectState saveObject(const btCollisionObject& object) {
  ObjectState s;
  s.pose = object.getWorldTransform();
  s.interpolation_pose = object.getInterpolationWorldTransform();
  s.interpolation_linear_velocity = object.getInterpolationLinearVelocity();
  s.interpolation_angular_velocity = object.getInterpolationAngularVelocity();
  s.friction = object.getFriction();
  s.rolling_friction = object.getRollingFriction();
  s.spinning_friction = object.getSpinningFriction();
  s.restitution = object.getRestitution();
  s.ccd_radius = object.getCcdSweptSphereRadius();
  s.ccd_threshold = object.getCcdMotionThreshold();
  s.contact_processing_threshold = object.getContactProcessingThreshold();
  s.deactivation_time = object.getDeactivationTime();
  s.activation_state = object.getActivationState();
  s.collision_flags = object.getCollisionFlags();
  return s;
}

void restoreObject(const ObjectState& s, btCollisionObject& object) {
  object.setCollisionFlags(s.collision_flags);
  object.setWorldTransform(s.pose);
  object.setInterpolationWorldTransform(s.interpolation_pose);
  object.setInterpolationLinearVelocity(s.interpolation_linear_velocity);
  object.setInterpolationAngularVelocity(s.interpolation_angular_velocity);
  object.setFriction(s.friction);
  object.setRollingFriction(s.rolling_friction);
  object.setSpinningFriction(s.spinning_friction);
  object.setRestitution(s.restitution);
  object.setCcdSweptSphereRadius(s.ccd_radius);
  object.setCcdMotionThreshold(s.ccd_threshold);
  object.setContactProcessingThreshold(s.contact_processing_threshold);
}

void restoreSleep(const ObjectState& s, btCollisionObject& object) {
  object.forceActivationState(s.activation_state);
  object.setDeactivationTime(s.deactivation_time);
}

BodyState saveBody(const btRigidBody& body) {
  BodyState s;
  static_cast<ObjectState&>(s) = saveObject(body);
  s.linear_velocity = body.getLinearVelocity();
  s.angular_velocity = body.getAngularVelocity();
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
  body.setFlags(s.flags);
  body.setCenterOfMassTransform(s.pose);  // its inertia follows
  restoreObject(s, body);
  body.setLinearVelocity(s.linear_velocity);
  body.setAngularVelocity(s.angular_velocity);
  restoreForces(s, body);
  body.setDamping(s.linear_damping, s.angular_damping);
  body.setSleepingThresholds(s.linear_sleeping_threshold, s.angular_sleeping_threshold);
}

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
