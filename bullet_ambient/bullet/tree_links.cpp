#include "bullet_ambient/bullet/tree_links.h"

#include <BulletDynamics/Featherstone/btMultiBody.h>

#include <algorithm>
#include <cmath>

#include "bullet_ambient/bullet/attach_link.h"
#include "bullet_ambient/bullet/flight_coupling.h"
#include "bullet_ambient/bullet/tree_state.h"

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {
namespace {

// At the pose and velocity of `step`.
void placeStandIns(AmbientTree& tree) {
  LinkDynamics& dynamics = tree.flight.dynamics();
  dynamics.setPose(tree.step.pose);
  dynamics.setVelocity(tree.step.start);
  for (const auto& link : tree.links) {
    const Matrix3& R = dynamics.rotation(link->link + 1);
    const Twist& twist = dynamics.twist(link->link + 1);
    link->stand_in.setWorldTransform(
        btTransform(toBulletMatrix(R), toBullet(dynamics.position(link->link + 1))));
    link->stand_in.setLinearVelocity(toBullet(Vector3(R * twist.linear)));
    link->stand_in.setAngularVelocity(toBullet(Vector3(R * twist.angular)));
  }
}

void prepareLink(AmbientLink& link, AmbientTree& tree, const TreeTask& task) {
  Link& in_tree = tree.tree.links[link.link + 1];
  AmbientBody& ambient = link.ambient;
  if (!prepareFluid(ambient, task.bodies, task.duration)) {
    in_tree.model = nullptr;
    in_tree.surroundings.ambient_velocity.setZero();
    return;
  }
  if (ambient.surface()) freezeAtSurface(ambient);  // links feel no waves and no wind
  in_tree.model = &ambient.model;
  in_tree.mass = 1 / static_cast<double>(link.stand_in.getInvMass());
  in_tree.surroundings.gravity = toVector3(task.gravity);
  in_tree.surroundings.ambient_velocity = ambient.medium.velocity;
  in_tree.surroundings.ambient_acceleration = ambient.medium.acceleration;
}

double energyFromFlow(AmbientTree& tree) {
  tree.step.spare = tree.step.start;
  tree.step.spare.segment<3>(3) -= flowAround(tree.tree);
  return tree.flight.dynamics().normSquared(tree.step.spare);
}

// Twice its kinetic energy, seen from the flow, with the fluid of the last substep. 0: no surface
// has been near, or a link was not in a fluid.
double energyAtSurface(AmbientTree& tree) {
  bool is_near = false;
  for (const auto& link : tree.links) {
    if (!tree.tree.links[link->link + 1].model) return 0;
    is_near = is_near || link->ambient.surface();
  }
  return is_near ? energyFromFlow(tree) : 0;
}

// The fluid around links that dive must not bring energy. What comes out leaves its own behind.
void passSurface(AmbientTree& tree, double before) {
  tree.flight.dynamics().setPose(tree.step.pose);
  const double now = energyFromFlow(tree);
  if (!(now > before)) return;
  countEnergyRemoved((now - before) / 2, tree);
  const Vector3 flow = flowAround(tree.tree);
  tree.step.start.segment<3>(3) -= flow;
  tree.step.start *= std::sqrt(before / now);
  tree.step.start.segment<3>(3) += flow;
}

}  // namespace

Vector3 flowAround(const LinkTree& tree) noexcept {
  if (tree.links.front().keeps_velocity) return Vector3::Zero();
  const Link* first = nullptr;
  for (const Link& link : tree.links) {
    if (!link.model) continue;
    if (!first) first = &link;
    if (link.surroundings.ambient_velocity != first->surroundings.ambient_velocity)
      return Vector3::Zero();
  }
  return first ? first->surroundings.ambient_velocity : Vector3(Vector3::Zero());
}

bool prepareLinks(AmbientTree& tree, const TreeTask& task) noexcept {
  readLinks(*tree.multi_body, tree.tree);
  for (const auto& link : tree.links) standIn(*link, *tree.multi_body, task.gravity);
  if (!task.bodies.regions.empty()) placeStandIns(tree);
  const double before = energyAtSurface(tree);
  bool is_in_fluid = false;
  for (const auto& link : tree.links) {
    prepareLink(*link, tree, task);
    is_in_fluid = is_in_fluid || tree.tree.links[link->link + 1].model;
  }
  if (before > 0) passSurface(tree, before);
  return is_in_fluid;
}

void moveStandIns(AmbientTree& tree) noexcept {
  readPose(*tree.multi_body, tree.step.pose);
  readVelocity(*tree.multi_body, tree.step.start);
  placeStandIns(tree);
}

void addCount(const FlightCount& count, AmbientTree& tree) noexcept {
  const auto loaded = std::count_if(tree.links.begin(), tree.links.end(), [](const auto& link) {
    return link->ambient.model.loads != nullptr;
  });
  const int evaluations = loaded > 0 ? count.load_evaluations / static_cast<int>(loaded) : 0;
  for (const auto& link : tree.links) {
    link->ambient.counters.substeps += count.substeps;
    if (link->ambient.model.loads) countLoads(link->ambient, evaluations);
  }
  AmbientCounters& counters = tree.links.front()->ambient.counters;
  counters.guarded += count.guarded;
  counters.coarse += count.coarse;
}

void countEnergyRemoved(double energy, AmbientTree& tree) noexcept {
  tree.links.front()->ambient.counters.energy_removed += energy;
}

void keepTreeAwake(AmbientTree& tree) noexcept {
  constexpr double kRestingTravel = 0.01, kRestingTime = 2;  // as of bodies
  if (!tree.multi_body->getCanSleep()) return;
  LinkDynamics& dynamics = tree.flight.dynamics();
  dynamics.setVelocity(tree.step.end);
  for (const auto& link : tree.links) {
    const AmbientBody& ambient = link->ambient;
    const Twist twist = dynamics.twist(link->link + 1);
    const double size = ambient.model.reference_length;
    const double travel = kRestingTime * (twist.linear.norm() + size * twist.angular.norm());
    if (!ambient.may_rest || travel > kRestingTravel * size) {
      tree.multi_body->wakeUp();
      return;
    }
  }
}

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
