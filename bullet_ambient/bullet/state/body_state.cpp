#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/bullet/core/body_motion.h"
#include "bullet_ambient/bullet/links/tree_step.h"
#include "bullet_ambient/bullet/members/attach.h"
#include "bullet_ambient/bullet/members/tree_state.h"
#include "bullet_ambient/bullet/state/bullet_state.h"
#include "bullet_ambient/immersed/floating_state.h"
#include "bullet_ambient/immersed/region_following.h"

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

namespace {

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

// Calls visit(collider, index in MultiBodyState::links).
template <class Visit>
void forEachCollider(btMultiBody& body, const Visit& visit) {
  std::size_t place = 0;
  for (int link = -1; link < body.getNumLinks(); ++link, ++place)
    if (btMultiBodyLinkCollider* collider = colliderOf(body, link)) visit(*collider, place);
}

// Sleep data of a multibody, for which Bullet has no public getters.
struct MultiBodySleep {
  btScalar &timer, &threshold, &timeout;
};
MultiBodySleep sleepOf(btMultiBody& body) noexcept;

// An explicit instantiation lends access to private members, as C++ allows.
template <btScalar btMultiBody::*kTimer, btScalar btMultiBody::*kThreshold,
          btScalar btMultiBody::*kTimeout>
struct SleepReader {
  friend MultiBodySleep sleepOf(btMultiBody& body) noexcept {
    return {body.*kTimer, body.*kThreshold, body.*kTimeout};
  }
};
template struct SleepReader<&btMultiBody::m_sleepTimer, &btMultiBody::m_sleepEpsilon,
                            &btMultiBody::m_sleepTimeout>;

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
  std::copy_n(link.m_jointPos, link.m_posVarCount, s.joint_position.begin());
  std::copy_n(link.m_jointTorque, link.m_dofCount, s.joint_force.begin());
  s.turn_in_parent = link.m_cachedRotParentToThis;
  s.way_from_parent = link.m_cachedRVector;
  s.pose = link.m_cachedWorldTransform;
  return s;
}

void restoreBase(const MultiBodyLinkState& s, btMultiBody& body) {
  body.setBaseMass(s.mass);
  body.setBaseInertia(s.inertia);
  body.addBaseForce(s.force);  // to zero: there is no setter
  body.addBaseTorque(s.torque);
}

void restoreLink(const MultiBodyLinkState& s, btMultibodyLink& link) {
  link.m_mass = s.mass;
  link.m_inertiaLocal = s.inertia;
  link.m_appliedForce = s.force;
  link.m_appliedTorque = s.torque;
  std::copy_n(s.joint_position.begin(), link.m_posVarCount, link.m_jointPos);
  std::copy_n(s.joint_force.begin(), link.m_dofCount, link.m_jointTorque);
  link.m_cachedRotParentToThis = link.m_cachedRotParentToThis_interpolate = s.turn_in_parent;
  link.m_cachedRVector = link.m_cachedRVector_interpolate = s.way_from_parent;
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

MultiBodyState saveMultiBody(btMultiBody& body) {
  auto s = fromBullet<MultiBodyState>(body);
  s.velocity.assign(body.getVelocityVector(), body.getVelocityVector() + velocityCount(body));
  for (int link = -1; link < body.getNumLinks(); ++link)
    s.links.push_back(link < 0 ? saveBase(body) : saveLink(body.getLink(link)));
  forEachCollider(body, [&](const btCollisionObject& collider, std::size_t i) {
    s.links[i].collider = fromBullet<ObjectState>(collider);
  });
  const MultiBodySleep sleep = sleepOf(body);
  s.sleep_timer = sleep.timer;
  s.sleep_threshold = sleep.threshold;
  s.sleep_timeout = sleep.timeout;
  return s;
}

MultiBodyJointState saveJoint(btMultiBodyConstraint& joint) {
  MultiBodyJointState s;
  if (!RowsOf::areMade(joint)) return s;
  for (int row = 0; row < joint.getNumRows(); ++row)
    s.applied_impulses.push_back(joint.getAppliedImpulse(row));
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
    constexpr int kQuaternion = 4;  // numbers of it, more than any other position has
    if (link >= 0 && body.getLink(link).m_posVarCount == kQuaternion &&
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
  AMBIENT_ASSERT(state.links.size() == static_cast<std::size_t>(body.getNumLinks()) + 1);
  body.clearForcesAndTorques();  // there is no setter
  toBullet(state, body);
  // As Bullet writes them itself (btMultiBodyDynamicsWorld, RK4).
  std::copy(state.velocity.begin(), state.velocity.end(),
            const_cast<btScalar*>(body.getVelocityVector()));
  restoreBase(state.links.front(), body);
  for (int link = 0; link < body.getNumLinks(); ++link)
    restoreLink(state.links[static_cast<std::size_t>(link) + 1], body.getLink(link));
  forEachCollider(body, [&](btCollisionObject& collider, std::size_t i) {
    toBullet(*state.links[i].collider, collider);
  });
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
  const MultiBodySleep sleep = sleepOf(body);
  sleep.timer = state.sleep_timer;
  sleep.threshold = state.sleep_threshold;
  sleep.timeout = state.sleep_timeout;
  forEachCollider(body, [&](btCollisionObject& collider, std::size_t i) {
    restoreSleep(*state.links[i].collider, collider);
  });
}

void wakeColliders(btMultiBody& body) {
  forEachCollider(body, [](btCollisionObject& collider, std::size_t) {
    if (!collider.isStaticObject()) collider.forceActivationState(ACTIVE_TAG);
  });
}

bool floatAgain(AmbientBody& ambient, const RigidState& now, const FluidRegions& regions) noexcept {
  if (!ambient.location.is_at_surface || !lastPlane(ambient)) return false;
  const auto entry = regions.all().find(ambient.location.region);
  if (entry == regions.all().end()) return false;
  const int media = ambient.models->findSurface(SurfaceKind(entry->second.region));
  if (media >= 0) restoreFloating(ambient, now, media);
  return media >= 0;
}

namespace {

std::unique_ptr<AmbientLink> makeLink(const LinkFluidState& saved, const MultiBodyState& state,
                                      const btMultiBody& body, AmbientBodies& registered) {
  const auto index = static_cast<std::size_t>(saved.link) + 1;
  if (saved.link < -1 || index >= state.links.size())
    throw std::invalid_argument("restoreState: a fluid is that of link " +
                                std::to_string(saved.link) + ", which the state has not");
  auto link = std::make_unique<AmbientLink>(saved.link);
  link->mass = inverseOf(state.links[index].mass, state.links[index].inertia);
  const AmbientLink* before = registered.trees.find(&body, saved.link);
  link->ambient =
      makeAmbient(saved.ambient, link->mass, registered, before ? &before->ambient : nullptr);
  return link;
}

}  // namespace

AmbientState saveAmbient(const AmbientBody& ambient, const InverseMass& mass) {
  const auto* last = std::get_if<LastFlight>(&ambient.outcome.motion);
  LastFlight flight = last ? *last : LastFlight{};
  flight.memory.load_W = ambient.outcome.lastLoad();
  AmbientState state;
  state.def = *ambient.def;
  state.medium = ambient.medium;
  state.location = ambient.location;
  state.flow = ambient.flow;
  state.memory = flight.memory;
  if (ambient.floating) state.waves = ambient.floating->waves;
  state.plane_B = lastPlane(ambient);
  if (ambient.wake) state.wake = *ambient.wake;
  state.left_W = flight.left_W;
  state.counters = ambient.counters;
  if (ambient.vessel) {
    state.has_met_water = ambient.vessel->is_known;
    state.has_sunk = ambient.vessel->has_sunk;
    state.holds = ambient.vessel->holds;
    state.sloshing = ambient.vessel->sloshing.now;
    state.is_shut = ambient.vessel->changes.is_shut;
    state.holes = ambient.vessel->changes.holes;
  }
  if (isModelStale(ambient, mass)) state.memory = {};  // as the next step will do
  return state;
}

void saveFluids(const AmbientTree& tree, MultiBodyState& state) {
  Coordinates now(tree.step.end.size());
  readVelocity(*tree.multi_body, now);
  const bool was_moved = tree.tree.size() > 1 && wasMovedByOthers(tree, now);
  for (const auto& link : tree.links) {
    LinkFluidState& saved = state.fluids.emplace_back();
    saved.link = link->link;
    saved.ambient = saveAmbient(link->ambient, link->mass);
    if (was_moved) saved.ambient.memory = {};  // as the next step will do
  }
  state.turn_reserve = tree.step.reserve;
}

namespace {

// Gives a body the water in its holds.
void fillHolds(const AmbientState& saved, AmbientBody& ambient) {
  const std::vector<Hold>& holds = ambient.def->fluid_body->holds;
  bool fits = saved.holds.size() == holds.size() && saved.sloshing.size() == holds.size();
  std::size_t openings = saved.holes.size();
  for (std::size_t i = 0; i < holds.size() && fits; ++i) {
    fits = saved.holds[i].volume <= holds[i].volume;
    openings += holds[i].openings.size();
  }
  const auto isOther = [&](const AddedHole& hole) {
    return hole.hold < 0 || static_cast<std::size_t>(hole.hold) >= holds.size();
  };
  const bool opens = saved.is_shut.size() == openings &&
                     std::none_of(saved.holes.begin(), saved.holes.end(), isOther);
  if (!fits || !opens)
    throw std::invalid_argument("restoreState: the state has more water, or more holds" +
                                std::string(fits ? " and openings" : "") + ", than fluid body '" +
                                ambient.def->fluid_body->name + "' has room for");
  if (!ambient.vessel) return;
  for (const AddedHole& hole : saved.holes) addHole(hole, *ambient.vessel);
  ambient.vessel->changes.is_shut = saved.is_shut;
  ambient.vessel->is_known = saved.has_met_water;
  ambient.vessel->has_sunk = saved.has_sunk;
  ambient.vessel->holds = saved.holds;
}

}  // namespace

AmbientBody makeAmbient(const AmbientState& saved, const InverseMass& mass,
                        AmbientBodies& registered, const AmbientBody* before) {
  if (!saved.def.fluid_body)
    throw std::invalid_argument("restoreState: an attached body of the state has no fluid body");
  checkDef("restoreState: body with fluid body '" + saved.def.fluid_body->name + "'", saved.def);
  AmbientBody ambient;
  AttachDef def = saved.def;
  if (before) def.flow.foils = before->def->flow.foils;
  ambient.def = internDef(std::move(def), registered.load_tables);
  refreshModels(ambient, mass, registered.regions, registered.load_tables);
  fillHolds(saved, ambient);
  // A region that does not exist here is left to the next step.
  enterMedium(ambient, saved.location, saved.medium);
  ambient.flow = saved.flow;
  LastFlight& flight = ambient.outcome.flight();
  flight.memory = saved.memory;
  flight.left_W = saved.left_W;
  if (ambient.floating && ambient.location.is_at_surface) {
    ambient.floating->waves = saved.waves;
    if (ambient.vessel) ambient.vessel->sloshing.now = saved.sloshing;
    if (saved.plane_B) ambient.floating->setPlane(*saved.plane_B);
  }
  if (ambient.wake) *ambient.wake = saved.wake;
  ambient.counters = saved.counters;
  return ambient;
}

std::vector<std::unique_ptr<AmbientLink>> makeLinks(const MultiBodyState& state,
                                                    const btMultiBody& body,
                                                    AmbientBodies& registered) {
  std::vector<std::unique_ptr<AmbientLink>> links;
  for (const LinkFluidState& saved : state.fluids) {
    for (const auto& other : links)
      if (other->link == saved.link)
        throw std::invalid_argument("restoreState: the state has two fluids of link " +
                                    std::to_string(saved.link));
    links.push_back(makeLink(saved, state, body, registered));
  }
  return links;
}

void insertLinks(const MultiBodyState& state, std::vector<std::unique_ptr<AmbientLink>> links,
                 btMultiBodyDynamicsWorld& world, btMultiBody& body, AmbientBodies& registered) {
  registered.trees.replace(world, body, std::move(links));
  AmbientTree* tree = registered.trees.find(&body);
  if (!tree) return;
  tree->step.reserve = state.turn_reserve;
  for (const auto& link : tree->links) link->now.gravity = toVector3(world.getGravity());
  computeLinkPosesNow(*tree);
  tree->step.end = tree->step.start;
  for (const auto& link : tree->links)
    if (floatAgain(link->ambient, link->now.state, registered.regions))
      link->frozen.freeze(link->ambient);
}

AMBIENT_END
