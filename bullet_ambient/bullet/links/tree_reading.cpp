#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointFeedback.h>

#include <algorithm>

#include "bullet_ambient/bullet/core/conversions.h"
#include "bullet_ambient/bullet/links/tree_step.h"
#include "bullet_ambient/bullet/members/tree_state.h"
#include "bullet_ambient/immersed/wrench_sensor.h"

AMBIENT_BEGIN

namespace {

bool isRead(const AmbientTree& tree) {
  return std::any_of(tree.links.begin(), tree.links.end(),
                     [](const auto& link) { return link->ambient.sensor != nullptr; });
}

template <class Visit>
void forEachRead(const AmbientTree& tree, const Visit& visit) {
  for (const auto& link : tree.links) {
    const Link& in_tree = tree.tree.links[link->link + 1];
    if (link->ambient.sensor && in_tree.model) visit(*link, link->link + 1);
  }
}

RigidState stateOf(const LinkDynamics& dynamics, int link) {
  return {Quaternion(dynamics.rotation(link)), dynamics.position(link), dynamics.twist(link)};
}

/// Whether nothing but the fluid and applied forces have moved it.
bool isFree(const AmbientTree& tree) {
  return tree.tree.size() == 1 && !tree.tree.links.front().keeps_velocity &&
         tree.step.outcome == Outcome::kFlown;
}

}  // namespace

void beginTreeReading(AmbientTree& tree) noexcept {
  if (!isRead(tree)) return;
  LinkDynamics& dynamics = tree.flight.dynamics();
  dynamics.setPose(tree.step.pose);
  dynamics.setVelocity(tree.step.start);
  forEachRead(tree, [&](AmbientLink& read, int link) {
    WrenchSensor& sensor = *read.ambient.sensor;
    Surroundings surroundings = tree.tree.links[link].surroundings;
    surroundings.applied -= pushByFlow(read.ambient, read.now.state.orientation);
    beginReading(read.ambient, stateOf(dynamics, link), surroundings, sensor);
    sensor.model = *tree.tree.links[link].model;
  });
}

void finishTreeReading(AmbientTree& tree, double duration) noexcept {
  if (!isRead(tree)) return;
  TreeStep& step = tree.step;
  LinkDynamics& dynamics = tree.flight.dynamics();
  const bool is_free = isFree(tree);
  readPose(*tree.multi_body, step.pose);
  dynamics.setPose(step.pose);
  dynamics.setVelocity(step.end);
  forEachRead(tree, [&](AmbientLink& read, int link) {
    WrenchSensor& sensor = *read.ambient.sensor;
    sensor.end = stateOf(dynamics, link);
    sensor.knows_impulse = is_free;
    const Matrix3& R = dynamics.rotation(link);
    const Wrench& of_change = step.impulses[link];
    if (step.meets_surface)
      sensor.added_mass_impulse_W = {R * of_change.torque, R * of_change.force};
  });
  movePose(tree.tree, step.pose, step.moved, -duration / 2, step.pose);
  dynamics.setPose(step.pose);
  dynamics.setVelocity(step.moved);
  forEachRead(tree, [&](AmbientLink& read, int link) {
    WrenchSensor& sensor = *read.ambient.sensor;
    finishReading(read.ambient,
                  {stateOf(dynamics, link), sensor.end, sensor.model,
                   step.outcome == Outcome::kFlown, duration},
                  sensor);
  });
}

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
      load =
          wholeLoad(computeSurfaceLoad(*link.model, dynamics.relativeTwist(i), link.surroundings),
                    link.model->resistance.get(), dynamics.relativeTwist(i));
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

bool wantsJointForces(const btMultiBody& body) {
  for (int i = 0; i < body.getNumLinks(); ++i)
    if (body.getLink(i).m_jointFeedback) return true;
  return false;
}

}  // namespace

void writeJointForces(AmbientTree& tree, const TreeTask& task) noexcept {
  if (!wantsJointForces(*tree.multi_body)) return;
  TreeStep& step = tree.step;
  Coordinates &acceleration = step.change, &forces = step.spare;  // not needed any more
  LinkDynamics& dynamics = tree.flight.dynamics();
  readPose(*tree.multi_body, step.pose);
  movePose(tree.tree, step.pose, step.moved, -task.duration / 2, step.pose);
  dynamics.setPose(step.pose);
  dynamics.setVelocity(step.moved);
  addOuterWrenches(tree, task.duration);
  dynamics.setPose(step.pose);  // again: it reads the applied wrenches
  acceleration = (step.end - step.start) / task.duration;
  dynamics.inverseDynamics(step.moved, acceleration, forces);
  const btContactSolverInfo& info = task.bodies.trees.world()->getSolverInfo();
  for (int i = 0; i < tree.multi_body->getNumLinks(); ++i) {
    btMultibodyLink& link = tree.multi_body->getLink(i);
    if (link.m_jointFeedback)
      link.m_jointFeedback->m_reactionForces =
          inBulletsFrame(dynamics.jointWrench(i + 1), link, info);
  }
}

AMBIENT_END
