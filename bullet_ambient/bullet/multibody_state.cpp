#include "bullet_ambient/bullet/multibody_state.h"

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "bullet_ambient/bullet/body_state.h"

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {
namespace {

// Bullet tells nobody what a multibody remembers of its sleep; as in AmbientBodies, an explicit
// instantiation lends access to it.
struct Sleep {
  btScalar &timer, &threshold, &timeout;
};
Sleep sleepOf(btMultiBody& body) noexcept;

template <btScalar btMultiBody::*kTimer, btScalar btMultiBody::*kThreshold,
          btScalar btMultiBody::*kTimeout>
struct SleepReader {
  friend Sleep sleepOf(btMultiBody& body) noexcept {
    return {body.*kTimer, body.*kThreshold, body.*kTimeout};
  }
};
template struct SleepReader<&btMultiBody::m_sleepTimer, &btMultiBody::m_sleepEpsilon,
                            &btMultiBody::m_sleepTimeout>;

// Before its first step a constraint has no place for impulses, which Bullet does not tell.
class RowsOf : public btMultiBodyConstraint {
 public:
  static bool areMade(const btMultiBodyConstraint& joint) {
    return (joint.*(&RowsOf::m_data)).size() >= joint.getNumRows();
  }
};

std::size_t velocityCount(const btMultiBody& body) {
  return 6 + static_cast<std::size_t>(body.getNumDofs());
}

template <class Body>  // const or not
auto* colliderOf(Body& body, int link) {
  return link < 0 ? body.getBaseCollider() : body.getLinkCollider(link);
}

template <class Visit>
void forEachCollider(const MultiBodyState& state, btMultiBody& body, const Visit& visit) {
  for (std::size_t i = 0; i < state.links.size(); ++i)
    if (state.links[i].collider)
      visit(*state.links[i].collider, *colliderOf(body, static_cast<int>(i) - 1));
}

MultiBodyLinkState saveBase(const btMultiBody& body) {
  MultiBodyLinkState s;
  s.mass = body.getBaseMass();
  s.inertia = body.getBaseInertia();
  s.force = body.getBaseForce();
  s.torque = body.getBaseTorque();
  return s;
}

MultiBodyLinkState saveLink(const btMultibodyLink& link) {
  MultiBodyLinkState s;
  s.mass = link.m_mass;
  s.inertia = link.m_inertiaLocal;
  s.force = link.m_appliedForce;
  s.torque = link.m_appliedTorque;
  s.pose = link.m_cachedWorldTransform;
  std::copy_n(link.m_jointPos, link.m_posVarCount, s.joint_position.begin());
  std::copy_n(link.m_jointPos_interpolate, link.m_posVarCount, s.interpolation_position.begin());
  std::copy_n(link.m_jointTorque, link.m_dofCount, s.joint_force.begin());
  return s;
}

void restoreBase(const MultiBodyState& state, btMultiBody& body) {
  const MultiBodyLinkState& base = state.links.front();
  body.setBaseMass(base.mass);
  body.setBaseInertia(base.inertia);
  body.clearForcesAndTorques();  // there is no setter
  body.addBaseForce(base.force);
  body.addBaseTorque(base.torque);
  body.setBasePos(state.position);
  body.setWorldToBaseRot(state.orientation);
  body.setInterpolateBasePos(state.interpolation_position);
  body.setInterpolateWorldToBaseRot(state.interpolation_orientation);
}

void restoreLink(const MultiBodyLinkState& s, btMultibodyLink& link) {
  link.m_mass = s.mass;
  link.m_inertiaLocal = s.inertia;
  link.m_appliedForce = s.force;
  link.m_appliedTorque = s.torque;
  std::copy_n(s.joint_position.begin(), link.m_posVarCount, link.m_jointPos);
  std::copy_n(s.interpolation_position.begin(), link.m_posVarCount, link.m_jointPos_interpolate);
  std::copy_n(s.joint_force.begin(), link.m_dofCount, link.m_jointTorque);
  link.updateCacheMultiDof();
  link.m_cachedWorldTransform = s.pose;
}

[[noreturn]] void refuse(const std::string& what, std::size_t number, const std::string& why) {
  throw std::invalid_argument("restoreState: the state of " + what + ' ' + std::to_string(number) +
                              ' ' + why);
}

// A quaternion of another length would scale what it turns.
bool isTurn(const std::array<btScalar, 7>& q) {
  const btScalar size = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
  return std::abs(size - 1) < btScalar(0.01);
}

}  // namespace

std::vector<btMultiBody*> multiBodiesOf(btCollisionWorld& world) {
  std::vector<btMultiBody*> bodies;
  if (auto* of = dynamic_cast<btMultiBodyDynamicsWorld*>(&world))
    for (int i = 0; i < of->getNumMultibodies(); ++i) bodies.push_back(of->getMultiBody(i));
  return bodies;
}

std::vector<btMultiBodyConstraint*> multiBodyJointsOf(btCollisionWorld& world) {
  std::vector<btMultiBodyConstraint*> joints;
  if (auto* of = dynamic_cast<btMultiBodyDynamicsWorld*>(&world))
    for (int i = 0; i < of->getNumMultiBodyConstraints(); ++i)
      joints.push_back(of->getMultiBodyConstraint(i));
  return joints;
}

MultiBodyState saveMultiBody(const btMultiBody& body) {
  MultiBodyState s;
  s.position = body.getBasePos();
  s.interpolation_position = body.getInterpolateBasePos();
  s.orientation = body.getWorldToBaseRot();
  s.interpolation_orientation = body.getInterpolateWorldToBaseRot();
  s.velocity.assign(body.getVelocityVector(), body.getVelocityVector() + velocityCount(body));
  s.links.push_back(saveBase(body));
  for (int i = 0; i < body.getNumLinks(); ++i) s.links.push_back(saveLink(body.getLink(i)));
  for (int i = -1; i < body.getNumLinks(); ++i)
    if (const btMultiBodyLinkCollider* collider = colliderOf(body, i))
      s.links[static_cast<std::size_t>(i) + 1].collider = saveObject(*collider);
  s.linear_damping = body.getLinearDamping();
  s.angular_damping = body.getAngularDamping();
  s.velocity_limit = body.getMaxCoordinateVelocity();
  const Sleep sleep = sleepOf(const_cast<btMultiBody&>(body));
  s.sleep_timer = sleep.timer;
  s.sleep_threshold = sleep.threshold;
  s.sleep_timeout = sleep.timeout;
  s.is_awake = body.isAwake();
  s.can_sleep = body.getCanSleep();
  s.can_wake_up = body.getCanWakeup();
  s.has_gyroscopic_term = body.getUseGyroTerm();
  return s;
}

MultiBodyJointState saveJoint(const btMultiBodyConstraint& joint) {
  MultiBodyJointState s;
  if (!RowsOf::areMade(joint)) return s;
  for (int row = 0; row < joint.getNumRows(); ++row)
    s.applied_impulses.push_back(const_cast<btMultiBodyConstraint&>(joint).getAppliedImpulse(row));
  return s;
}

void requireFits(const MultiBodyState& state, const btMultiBody& body, std::size_t number) {
  const std::string what = "multibody";
  if (state.links.size() != static_cast<std::size_t>(body.getNumLinks()) + 1)
    refuse(what, number,
           "has " + std::to_string(state.links.size() - 1) + " links, but the world's has " +
               std::to_string(body.getNumLinks()));
  if (state.velocity.size() != velocityCount(body))
    refuse(what, number,
           "has " + std::to_string(state.velocity.size()) + " velocities, but the world's has " +
               std::to_string(velocityCount(body)));
  for (std::size_t i = 0; i < state.links.size(); ++i) {
    const int link = static_cast<int>(i) - 1;
    const std::string name = "link " + std::to_string(link);
    if (state.links[i].collider.has_value() != (colliderOf(body, link) != nullptr))
      refuse(what, number, "and the world's have not both a collider of " + name);
    if (link >= 0 && body.getLink(link).m_jointType == btMultibodyLink::eSpherical &&
        !isTurn(state.links[i].joint_position))
      refuse(what, number, "has a joint of " + name + " whose quaternion is not of unit length");
  }
}

void requireFits(const MultiBodyJointState& state, const btMultiBodyConstraint& joint,
                 std::size_t number) {
  const std::size_t rows = state.applied_impulses.size();
  if (rows > 0 && rows != static_cast<std::size_t>(joint.getNumRows()))
    refuse("multibody joint", number,
           "has " + std::to_string(rows) + " rows, but the world's has " +
               std::to_string(joint.getNumRows()));
}

void restoreMultiBody(const MultiBodyState& state, btMultiBody& body) {
  restoreBase(state, body);
  for (int i = 0; i < body.getNumLinks(); ++i)
    restoreLink(state.links[static_cast<std::size_t>(i) + 1], body.getLink(i));
  forEachCollider(state, body, restoreObject);
  // Where Bullet keeps them; it writes there itself (btMultiBodyDynamicsWorld, RK4).
  std::copy(state.velocity.begin(), state.velocity.end(),
            const_cast<btScalar*>(body.getVelocityVector()));
  body.setLinearDamping(state.linear_damping);
  body.setAngularDamping(state.angular_damping);
  body.setMaxCoordinateVelocity(state.velocity_limit);
  body.setUseGyroTerm(state.has_gyroscopic_term);
}

void restoreJoint(const MultiBodyJointState& state, btMultiBodyConstraint& joint) {
  if (state.applied_impulses.empty() && !RowsOf::areMade(joint)) return;
  if (!RowsOf::areMade(joint)) joint.finalizeMultiDof();
  for (int row = 0; row < joint.getNumRows(); ++row)
    joint.internalSetAppliedImpulse(
        row, state.applied_impulses.empty() ? 0 : state.applied_impulses[std::size_t(row)]);
}

void restoreSleep(const MultiBodyState& state, btMultiBody& body) {
  body.setCanWakeup(true);
  body.setCanSleep(state.can_sleep);
  if (state.is_awake) {
    body.wakeUp();
  } else {
    body.goToSleep();
  }
  body.setCanWakeup(state.can_wake_up);
  const Sleep sleep = sleepOf(body);
  sleep.timer = state.sleep_timer;
  sleep.threshold = state.sleep_threshold;
  sleep.timeout = state.sleep_timeout;
  forEachCollider(state, body, [](const ObjectState& s, btCollisionObject& collider) {
    restoreSleep(s, collider);
  });
}

void wakeColliders(btMultiBody& body) {
  for (int i = -1; i < body.getNumLinks(); ++i)
    if (auto* collider = colliderOf(body, i))
      if (!collider->isStaticObject()) collider->forceActivationState(ACTIVE_TAG);
}

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
