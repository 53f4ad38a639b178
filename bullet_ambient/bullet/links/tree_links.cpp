#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointFeedback.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "bullet_ambient/bullet/core/body_motion.h"
#include "bullet_ambient/bullet/core/conversions.h"
#include "bullet_ambient/bullet/links/tree_step.h"
#include "bullet_ambient/bullet/members/attach.h"
#include "bullet_ambient/bullet/members/flight_coupling.h"
#include "bullet_ambient/bullet/members/tree_state.h"
#include "bullet_ambient/force/loads/surface_loads.h"
#include "bullet_ambient/immersed/floating_state.h"
#include "bullet_ambient/immersed/wrench_sensor.h"

AMBIENT_BEGIN
namespace {

void prepareLink(AmbientLink& link, AmbientTree& tree, AmbientBodies& bodies, double duration) {
  Link& in_tree = tree.tree.links[link.link + 1];
  AmbientBody& ambient = link.ambient;
  in_tree.surroundings.flow = nullptr;
  if (link.mass.mass == 0 ||
      !prepareFluid(ambient, &link.now, link.now.twist_W, link.mass, bodies, duration)) {
    in_tree.model = nullptr;
    in_tree.surroundings.ambient_velocity.setZero();
    return;
  }
  in_tree.model = &ambient.model();
  in_tree.memory = &ambient.outcome.flight().memory;
  if (ambient.surface()) {
    flotationNow(ambient, link.now);
    link.frozen.freeze(ambient);
    in_tree.model = &*link.frozen;
    in_tree.memory = nullptr;  // its loads are those on the part that is wet when the step begins
  }
  in_tree.mass = 1 / link.mass.mass;
  in_tree.surroundings.gravity = link.now.gravity;
  in_tree.surroundings.ambient_velocity = ambient.medium.velocity;
  in_tree.surroundings.ambient_acceleration = ambient.medium.acceleration;
  in_tree.surroundings.load_scale = ambient.load_scale;
  addFlowAlong(ambient, link.now.state.orientation, in_tree.surroundings);
}

template <class IsTrue>
bool isOfAny(const AmbientTree& tree, const IsTrue& is_true) {
  return std::any_of(tree.links.begin(), tree.links.end(),
                     [&](const auto& link) { return is_true(link->ambient); });
}

// True if a link has a wake that depends on its motion (followWake()).
bool hasWakes(const AmbientTree& tree) {
  return isOfAny(tree, [](const AmbientBody& ambient) {
    const auto& loads = ambient.model().loads;
    return loads && loads->wakeShare() > 0;
  });
}

// True if a link drifts.
bool moves(AmbientTree& tree) {
  LinkDynamics& dynamics = tree.flight.dynamics();
  dynamics.setVelocity(tree.step.end);
  return std::any_of(tree.links.begin(), tree.links.end(), [&dynamics](const auto& link) {
    const Twist twist = dynamics.twist(link->link + 1);
    return drifts(twist.linear.norm(), twist.angular.norm(),
                  link->ambient.model().reference_length);
  });
}

// True if a tree of one link floats in an unstable balance. False for trees with joints, which may
// hold their links.
bool floatsUnstably(AmbientTree& tree) {
  AmbientLink& base = *tree.links.front();
  if (tree.tree.size() > 1 || !base.ambient.surface()) return false;
  readPose(*tree.multi_body, tree.step.pose);
  computeLinkPoses(tree, tree.step.end);
  return !mayRestAtSurface(base.ambient, base.now);
}

}  // namespace

void computeLinkPoses(AmbientTree& tree, const CoordinatesIn& u) noexcept {
  LinkDynamics& dynamics = tree.flight.dynamics();
  dynamics.moveTo(tree.step.pose);
  dynamics.setVelocity(u);
  for (const auto& link : tree.links) {
    const Matrix3& R = dynamics.rotation(link->link + 1);
    const Twist& twist = dynamics.twist(link->link + 1);
    const btTransform pose(toBulletMatrix(R), toBullet(dynamics.position(link->link + 1)));
    setMotion(pose, {rounded(R * twist.angular), rounded(R * twist.linear)}, link->now);
  }
}

bool wasMovedByOthers(const AmbientTree& tree, const CoordinatesIn& now) noexcept {
  constexpr double kRounding = 16 * static_cast<double>(std::numeric_limits<btScalar>::epsilon());
  const Coordinates& left = tree.step.end;
  return !((now - left).cwiseAbs().maxCoeff() <= kRounding * left.cwiseAbs().maxCoeff());
}

void forgetLoads(AmbientTree& tree) noexcept {
  for (const auto& link : tree.links) forgetFlight(link->ambient);
}

bool prepareLinks(AmbientTree& tree, AmbientBodies& bodies, double duration) noexcept {
  readLinks(*tree.multi_body, tree.tree);
  const Vector3 gravity = toVector3(bodies.trees.world()->getGravity());
  for (const auto& link : tree.links) {
    link->mass = inverseMassOf(*tree.multi_body, link->link);
    link->now.gravity = gravity;
  }
  if (!bodies.regions.empty() || tree.tree.size() == 1 || hasWakes(tree))
    computeLinkPoses(tree, tree.step.start);
  bool is_in_fluid = false;
  for (const auto& link : tree.links) {
    prepareLink(*link, tree, bodies, duration);
    is_in_fluid = is_in_fluid || tree.tree.links[link->link + 1].model;
  }
  return is_in_fluid;
}

void computeLinkPosesNow(AmbientTree& tree) noexcept {
  readPose(*tree.multi_body, tree.step.pose);
  readVelocity(*tree.multi_body, tree.step.start);
  computeLinkPoses(tree, tree.step.start);
}

void addCount(const FlightCount& count, AmbientTree& tree) noexcept {
  const auto loaded = std::count_if(tree.links.begin(), tree.links.end(), [](const auto& link) {
    return link->ambient.model().loads != nullptr;
  });
  const int evaluations = loaded > 0 ? count.load_evaluations / static_cast<int>(loaded) : 0;
  for (const auto& link : tree.links) {
    link->ambient.counters.substeps += count.substeps;
    if (link->ambient.model().loads) countLoads(link->ambient, evaluations);
  }
  AmbientCounters& counters = tree.links.front()->ambient.counters;
  counters.guarded += count.guarded;
  counters.coarse += count.coarse;
  counters.halted += count.halted;
}

void countEnergyRemoved(double energy, AmbientTree& tree) noexcept {
  tree.links.front()->ambient.counters.energy_removed += energy;
}

void keepTreeAwake(AmbientTree& tree) noexcept {
  if (!tree.multi_body->getCanSleep()) return;
  const bool has_rows = tree.step.outcome == Outcome::kRows;
  const auto floats = [](const AmbientBody& ambient) { return ambient.surface() != nullptr; };
  const bool is_carried = !has_rows || isOfAny(tree, floats);
  const bool is_unsteady = isOfAny(tree, [](const auto& ambient) { return !ambient.may_rest; });
  if (is_unsteady || (is_carried && moves(tree)) || (!has_rows && floatsUnstably(tree)))
    tree.multi_body->wakeUp();
}

namespace {

// Sets a turn that Bullet has computed up to kTurnRounding. Returns true if a number has changed.
bool settleTurn(btQuaternion& now, btQuaternion exact) {
  exact.normalize();
  if (now == exact) return false;
  const auto half_angle = static_cast<double>((now - exact).length());
  if (!(2 * half_angle <= kTurnRounding)) return false;
  now = exact;
  return true;
}

// Functions below return true if they have changed a number. `h`: for which Bullet has moved the
// tree [s].

// Returns three coordinates, from `first` on, of the velocity that Bullet has moved a tree by.
btVector3 velocityAlong(const TreeStep& step, int first) {
  return toBullet(Vector3(step.moved.segment<3>(first)));
}

bool settleBase(AmbientTree& tree, btScalar h) {
  const btVector3 spin = velocityAlong(tree.step, 0);
  if (tree.tree.links.front().keeps_position || spin.isZero()) return false;
  btQuaternion to_base = tree.multi_body->getWorldToBaseRot();
  if (!settleTurn(to_base, tree.step.to_base * turnInStep(spin, h).inverse())) return false;
  tree.multi_body->setWorldToBaseRot(to_base);
  return true;
}

bool settleSpherical(const JointPosition& from, const btVector3& spin, btScalar h,
                     btMultibodyLink& link) {
  if (spin.isZero()) return false;
  btScalar* p = link.m_jointPos;
  btQuaternion now(p[0], p[1], p[2], p[3]);
  const btQuaternion start = toBullet(Quaternion(from[3], from[0], from[1], from[2]));
  if (!settleTurn(now, turnInStep(quatRotate(start, spin), h) * start)) return false;
  for (int i = 0; i < 4; ++i) p[i] = now[i];
  link.updateCacheMultiDof();
  return true;
}

// Bullet has turned the way by the angle at the end of the step.
void settlePlanar(const JointPosition& from, const btVector3& velocity, btScalar h,
                  btMultibodyLink& link) {
  constexpr btScalar kRounding = 16 * std::numeric_limits<btScalar>::epsilon();
  const btVector3 turned =
      quatRotate(turnAbout(link.getAxisTop(0), link.m_jointPos[0]),
                 velocity[1] * link.getAxisBottom(1) + velocity[2] * link.getAxisBottom(2));
  for (int i : {1, 2}) {
    const auto start = static_cast<btScalar>(from[static_cast<std::size_t>(i)]);
    const btScalar turn = link.getAxisBottom(i).dot(turned) * h, exact = start + turn;
    const btScalar rounding = kRounding * (std::abs(start) + std::abs(turn));
    if (std::abs(link.m_jointPos[i] - exact) <= rounding) link.m_jointPos[i] = exact;
  }
}

bool settleJoints(AmbientTree& tree, btScalar h) {
  bool has_changed = false;
  int first = 6;
  for (int i = 0; i < tree.multi_body->getNumLinks(); ++i) {
    const Link& link = tree.tree.links[static_cast<std::size_t>(i) + 1];
    btMultibodyLink& bullet = tree.multi_body->getLink(i);
    const JointPosition& from = tree.step.pose.joints[static_cast<std::size_t>(i) + 1];
    if (link.joint.kind == JointKind::kSpherical && !link.keeps_position)
      has_changed |= settleSpherical(from, velocityAlong(tree.step, first), h, bullet);
    if (link.joint.kind == JointKind::kPlanar && !link.keeps_position)
      settlePlanar(from, velocityAlong(tree.step, first), h, bullet);
    has_changed |= settleLink(bullet);
    first += axisCount(link.joint.kind);
  }
  return has_changed;
}

}  // namespace

void settleTree(AmbientTree& tree, double duration) noexcept {
  const auto h = static_cast<btScalar>(duration);
  const bool has_turned = settleBase(tree, h);
  if (settleJoints(tree, h) || has_turned)
    tree.multi_body->updateCollisionObjectWorldTransforms(tree.to_local, tree.origins);
}

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

void writeJointForces(AmbientTree& tree, double duration,
                      const btContactSolverInfo& info) noexcept {
  if (!wantsJointForces(*tree.multi_body)) return;
  TreeStep& step = tree.step;
  Coordinates &acceleration = step.change, &forces = step.spare;  // not needed any more
  LinkDynamics& dynamics = tree.flight.dynamics();
  readPose(*tree.multi_body, step.pose);
  movePose(tree.tree, step.pose, step.moved, -duration / 2, step.pose);
  dynamics.setPose(step.pose);
  dynamics.setVelocity(step.moved);
  addOuterWrenches(tree, duration);
  dynamics.setPose(step.pose);  // again: it reads the applied wrenches
  acceleration = (step.end - step.start) / duration;
  dynamics.inverseDynamics(step.moved, acceleration, forces);
  for (int i = 0; i < tree.multi_body->getNumLinks(); ++i) {
    btMultibodyLink& link = tree.multi_body->getLink(i);
    if (link.m_jointFeedback)
      link.m_jointFeedback->m_reactionForces =
          inBulletsFrame(dynamics.jointWrench(i + 1), link, info);
  }
}

AMBIENT_END
