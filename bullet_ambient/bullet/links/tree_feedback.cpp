#include "bullet_ambient/bullet/links/tree_feedback.h"

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointFeedback.h>

#include "bullet_ambient/bullet/members/tree_state.h"

AMBIENT_BEGIN
namespace {

// Adds surface loads, forces of rows, and the mean force of a water surface at the end of the step
// to the applied wrenches of all links but the base, whose wrench does not matter to joint forces.
void addOuterWrenches(AmbientTree& tree, double duration) {
  LinkDynamics& dynamics = tree.flight.dynamics();
  for (int i = 1; i < tree.tree.size(); ++i) {
    Link& link = tree.tree.links[i];
    const btMultibodyLink& bullet = tree.multi_body->getLink(i - 1);
    link.surroundings.applied +=
        {toVector3(bullet.m_appliedConstraintTorque), toVector3(bullet.m_appliedConstraintForce)};
    Wrench load;
    if (link.model && link.model->loads)
      load = computeSurfaceLoad(*link.model, dynamics.relativeTwist(i), link.surroundings).wrench;
    if (tree.step.meets_surface) load += 1 / duration * tree.step.impulses[i];
    const Matrix3& R = dynamics.rotation(i);
    link.surroundings.applied += {R * load.torque, R * load.force};
  }
}

// Brings a joint wrench at the link's centre of mass, in its axes, to the point and axes that the
// solver's settings for joint feedback ask for.
btSpatialForceVector inBulletsFrame(const Wrench& wrench, const btMultibodyLink& link,
                                    const btContactSolverInfo& info) {
  btVector3 torque = toBullet(wrench.torque), force = toBullet(wrench.force);
  if (info.m_jointFeedbackInJointFrame) torque -= force.cross(link.m_dVector);
  if (info.m_jointFeedbackInWorldSpace) {
    torque = link.m_cachedWorldTransform.getBasis() * torque;
    force = link.m_cachedWorldTransform.getBasis() * force;
  }
  return {torque, force};
}

}  // namespace

bool wantsJointForces(const btMultiBody& body) noexcept {
  for (int i = 0; i < body.getNumLinks(); ++i)
    if (body.getLink(i).m_jointFeedback) return true;
  return false;
}

void writeJointForces(AmbientTree& tree, const TreeTask& task) noexcept {
  TreeStep& step = tree.step;
  LinkDynamics& dynamics = tree.flight.dynamics();
  readPose(*tree.multi_body, step.pose);
  movePose(tree.tree, step.pose, step.moved, -task.duration / 2, step.pose);
  dynamics.setPose(step.pose);
  dynamics.setVelocity(step.moved);
  addOuterWrenches(tree, task.duration);
  dynamics.setPose(step.pose);  // again: it reads the applied wrenches
  step.change = (step.end - step.start) / task.duration;
  dynamics.inverseDynamics(step.moved, step.change, step.spare);
  const btContactSolverInfo& info = task.bodies.trees.world()->getSolverInfo();
  for (int i = 0; i < tree.multi_body->getNumLinks(); ++i) {
    btMultibodyLink& link = tree.multi_body->getLink(i);
    if (link.m_jointFeedback)
      link.m_jointFeedback->m_reactionForces =
          inBulletsFrame(dynamics.jointWrench(i + 1), link, info);
  }
}

AMBIENT_END
