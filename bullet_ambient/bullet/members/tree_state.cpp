#include "bullet_ambient/bullet/members/tree_state.h"

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

#include <algorithm>
#include <atomic>
#include <cstring>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/bullet/core/conversions.h"

AMBIENT_BEGIN

namespace {

// btMultiBodyDynamicsWorld finds the room in the same way.
btScalar* roomOf(const btMultiBody& body) noexcept {
  const int dofs = body.getNumDofs();
  return const_cast<btScalar*>(body.getVelocityVector()) + 6 + dofs + dofs * dofs;
}

}  // namespace

int instanceNumber(const btMultiBody& body) noexcept {
  int number = 0;
  std::memcpy(&number, roomOf(body), sizeof number);
  return number;
}

void setInstanceNumber(btMultiBody& body, int number) noexcept {
  AMBIENT_ASSERT(number > 0);
  std::memcpy(roomOf(body), &number, sizeof number);
}

int giveInstanceNumber(btMultiBody& body) noexcept {
  static std::atomic<int> last{0};
  const int known = instanceNumber(body);
  if (known > 0) return known;
  const int number = ++last;
  setInstanceNumber(body, number);
  return number;
}

namespace {

JointKind kindOf(const btMultibodyLink& link) {
  static_assert(static_cast<int>(JointKind::kRevolute) == btMultibodyLink::eRevolute &&
                static_cast<int>(JointKind::kFixed) == btMultibodyLink::eFixed);
  return static_cast<JointKind>(std::min<int>(link.m_jointType, btMultibodyLink::eFixed));
}

Joint jointOf(const btMultibodyLink& link) {
  Joint joint;
  joint.kind = kindOf(link);
  joint.zero_axes = toQuaternion(link.m_zeroRotParentToThis).toRotationMatrix().transpose();
  joint.parent_to_pivot = toVector3(link.m_eVector);
  joint.pivot_to_link = toVector3(link.m_dVector);
  // Bullet's planar joint has no pivot on the side of the link, and leaves the vector unset.
  if (joint.kind == JointKind::kPlanar) joint.pivot_to_link.setZero();
  for (int i = 0; i < axisCount(joint.kind); ++i)
    joint.axes[i] =
        stack(toVector3(link.m_axes[i].m_topVec), toVector3(link.m_axes[i].m_bottomVec));
  return joint;
}

// By what is cheap to compare: in every substep.
bool hasJoint(const btMultibodyLink& link, const Joint& joint) {
  if (kindOf(link) != joint.kind || toVector3(link.m_eVector) != joint.parent_to_pivot)
    return false;
  if (joint.kind != JointKind::kPlanar && toVector3(link.m_dVector) != joint.pivot_to_link)
    return false;
  for (int i = 0; i < axisCount(joint.kind); ++i)
    if (toVector3(link.m_axes[i].m_topVec) != joint.axes[i].head<3>() ||
        toVector3(link.m_axes[i].m_bottomVec) != joint.axes[i].tail<3>())
      return false;
  return true;
}

Link& linkOf(LinkTree& tree, int link) { return tree.links[link + 1]; }

// Returns Bullet's own velocities; Bullet writes there itself (btMultiBodyDynamicsWorld, RK4).
btScalar* velocities(btMultiBody& body) { return const_cast<btScalar*>(body.getVelocityVector()); }

btScalar* changes(btMultiBody& body) {
  return const_cast<btScalar*>(body.getDeltaVelocityVector());
}

int coordinatesOf(const btMultiBody& body) { return 6 + body.getNumDofs(); }

void readAll(const btScalar* from, CoordinatesOut& to) {
  for (Eigen::Index i = 0; i < to.size(); ++i) to[i] = static_cast<double>(from[i]);
}

btScalar withinLimit(const btMultiBody& body, double velocity) {
  const auto limit = static_cast<double>(body.getMaxCoordinateVelocity());
  return static_cast<btScalar>(std::clamp(velocity, -limit, limit));
}

void readBase(const btMultiBody& body, Link& base) {
  base.mass = static_cast<double>(body.getBaseMass());
  base.inertia = toVector3(body.getBaseInertia());
  base.surroundings.applied = {toVector3(body.getBaseTorque()), toVector3(body.getBaseForce())};
  base.keeps_velocity = body.isBaseStaticOrKinematic();
  base.keeps_position = body.isBaseKinematic();
}

void readLink(const btMultiBody& body, int index, Link& link) {
  const btMultibodyLink& from = body.getLink(index);
  link.mass = static_cast<double>(from.m_mass);
  link.inertia = toVector3(from.m_inertiaLocal);
  link.surroundings.applied = {toVector3(from.m_appliedTorque), toVector3(from.m_appliedForce)};
  for (int i = 0; i < from.m_dofCount; ++i)
    link.joint_force[i] = static_cast<double>(from.m_jointTorque[i]);
  link.keeps_velocity = body.isLinkAndAllAncestorsKinematic(index);
  link.keeps_position = from.m_collider && from.m_collider->isStaticOrKinematic();
}

}  // namespace

LinkTree makeLinkTree(const btMultiBody& body) {
  LinkTree tree;
  tree.links.resize(body.getNumLinks() + 1);
  for (int i = 0; i < body.getNumLinks(); ++i) {
    linkOf(tree, i).parent = body.getLink(i).m_parent + 1;
    linkOf(tree, i).joint = jointOf(body.getLink(i));
  }
  readLinks(body, tree);
  return tree;
}

bool hasLinksOf(const btMultiBody& body, const LinkTree& tree) noexcept {
  if (tree.size() != body.getNumLinks() + 1) return false;
  for (int i = 0; i < body.getNumLinks(); ++i) {
    const Link& link = tree.links[i + 1];
    if (link.parent != body.getLink(i).m_parent + 1) return false;
    if (!hasJoint(body.getLink(i), link.joint)) return false;
  }
  return true;
}

void readLinks(const btMultiBody& body, LinkTree& tree) noexcept {
  tree.linear_damping = static_cast<double>(body.getLinearDamping());
  tree.angular_damping = static_cast<double>(body.getAngularDamping());
  tree.has_gyroscopic_term = body.getUseGyroTerm();
  readBase(body, linkOf(tree, -1));
  for (int i = 0; i < body.getNumLinks(); ++i) readLink(body, i, linkOf(tree, i));
}

void readPose(const btMultiBody& body, TreePose& pose) noexcept {
  pose.orientation = toQuaternion(body.getWorldToBaseRot()).conjugate();
  pose.position = toVector3(body.getBasePos());
  pose.joints.resize(body.getNumLinks() + 1);
  for (int i = 0; i < body.getNumLinks(); ++i) {
    JointPosition& joint = pose.joints[i + 1];
    for (std::size_t k = 0; k < joint.size(); ++k)
      joint[k] = static_cast<double>(body.getLink(i).m_jointPos[k]);
  }
}

void readVelocity(const btMultiBody& body, CoordinatesOut u) noexcept {
  AMBIENT_ASSERT(u.size() == coordinatesOf(body));
  readAll(body.getVelocityVector(), u);
}

void readChange(const btMultiBody& body, CoordinatesOut change) noexcept {
  AMBIENT_ASSERT(change.size() == coordinatesOf(body));
  readAll(body.getDeltaVelocityVector(), change);
}

void readChangedVelocity(const btMultiBody& body, CoordinatesOut u) noexcept {
  const btScalar *now = body.getVelocityVector(), *change = body.getDeltaVelocityVector();
  for (Eigen::Index i = 0; i < u.size(); ++i)
    u[i] = static_cast<double>(withinLimit(body, static_cast<double>(now[i] + change[i])));
}

void writeVelocity(btMultiBody& body, const CoordinatesIn& u) noexcept {
  AMBIENT_ASSERT(u.size() == coordinatesOf(body));
  for (Eigen::Index i = 0; i < u.size(); ++i) velocities(body)[i] = withinLimit(body, u[i]);
}

void addVelocity(btMultiBody& body, const CoordinatesIn& change) noexcept {
  AMBIENT_ASSERT(change.size() == coordinatesOf(body));
  for (Eigen::Index i = 0; i < change.size(); ++i) {
    btScalar& velocity = velocities(body)[i];
    velocity = withinLimit(body, static_cast<double>(velocity) + change[i]);
  }
}

void addChange(btMultiBody& body, const CoordinatesIn& change) noexcept {
  AMBIENT_ASSERT(change.size() == coordinatesOf(body));
  for (Eigen::Index i = 0; i < change.size(); ++i)
    changes(body)[i] += static_cast<btScalar>(change[i]);
}

void clearChange(btMultiBody& body) noexcept {
  std::fill(changes(body), changes(body) + coordinatesOf(body), btScalar(0));
}

bool isAsleep(const btMultiBody& body) noexcept {
  for (int link = -1; link < body.getNumLinks(); ++link) {
    const btCollisionObject* collider = colliderOf(body, link);
    if (collider && collider->getActivationState() == ISLAND_SLEEPING) return true;
  }
  return false;
}

btTransform linkTransform(const btMultiBody& body, int link) {
  if (link < 0) return body.getBaseWorldTransform();
  return btTransform(body.localFrameToWorld(link, btMatrix3x3::getIdentity()),
                     body.localPosToWorld(link, btVector3(0, 0, 0)));
}

AMBIENT_END
