#include "bullet_ambient/bullet/links/tree_links.h"

#include <BulletDynamics/Featherstone/btMultiBody.h>

#include <algorithm>
#include <limits>

#include "bullet_ambient/bullet/core/body_motion.h"
#include "bullet_ambient/bullet/members/attach.h"
#include "bullet_ambient/bullet/members/flight_coupling.h"
#include "bullet_ambient/bullet/members/tree_state.h"
#include "bullet_ambient/force/loads/surface_loads.h"
#include "bullet_ambient/immersed/floating_state.h"

AMBIENT_BEGIN

namespace {

void prepareLink(AmbientLink& link, AmbientTree& tree, const TreeTask& task) {
  Link& in_tree = tree.tree.links[link.link + 1];
  AmbientBody& ambient = link.ambient;
  in_tree.surroundings.flow = nullptr;
  const StepStart start{&link.now, link.now.twist_W, link.mass};
  if (link.mass.mass == 0 || !prepareFluid(ambient, start, task.bodies, task.duration)) {
    in_tree.model = nullptr;
    in_tree.surroundings.ambient_velocity.setZero();
    return;
  }
  in_tree.model = &ambient.model();
  in_tree.memory = &ambient.outcome.flight().memory;
  if (ambient.surface()) {
    standNow(ambient, link.now);
    link.frozen.freeze(ambient);
    in_tree.model = &*link.frozen;
    in_tree.memory = nullptr;  // its loads are those on the part that is wet when the step begins
  }
  in_tree.mass = 1 / link.mass.mass;
  in_tree.surroundings.gravity = link.now.gravity;
  in_tree.surroundings.ambient_velocity = ambient.medium.velocity;
  in_tree.surroundings.ambient_acceleration = ambient.medium.acceleration;
  in_tree.surroundings.load_share = ambient.load_share;
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

// True if a link moves by more than a hundredth of its size in 2 s, Bullet's time before sleep.
bool moves(AmbientTree& tree) {
  constexpr double kRestingTravel = 0.01, kRestingTime = 2;  // those of bodies
  LinkDynamics& dynamics = tree.flight.dynamics();
  dynamics.setVelocity(tree.step.end);
  return std::any_of(tree.links.begin(), tree.links.end(), [&dynamics](const auto& link) {
    const AmbientBody& ambient = link->ambient;
    const Twist twist = dynamics.twist(link->link + 1);
    const double size = ambient.model().reference_length;
    const double travel = kRestingTime * (twist.linear.norm() + size * twist.angular.norm());
    return travel > kRestingTravel * size;
  });
}

// True if a tree of one link floats in an unstable balance. False for trees with joints, which may
// hold their links.
bool standsOnSaddle(AmbientTree& tree) {
  AmbientLink& base = *tree.links.front();
  if (tree.tree.size() > 1 || !base.ambient.surface()) return false;
  readPose(*tree.multi_body, tree.step.pose);
  placeLinks(tree, tree.step.end);
  return !mayRestAtSurface(base.ambient, base.now);
}

}  // namespace

void placeLinks(AmbientTree& tree, const CoordinatesIn& u) noexcept {
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

bool prepareLinks(AmbientTree& tree, const TreeTask& task) noexcept {
  readLinks(*tree.multi_body, tree.tree);
  for (const auto& link : tree.links) {
    link->mass = inverseMassOf(*tree.multi_body, link->link);
    link->now.gravity = toVector3(task.gravity);
  }
  if (!task.bodies.regions.empty() || tree.tree.size() == 1 || hasWakes(tree))
    placeLinks(tree, tree.step.start);
  bool is_in_fluid = false;
  for (const auto& link : tree.links) {
    prepareLink(*link, tree, task);
    is_in_fluid = is_in_fluid || tree.tree.links[link->link + 1].model;
  }
  return is_in_fluid;
}

void placeLinksNow(AmbientTree& tree) noexcept {
  readPose(*tree.multi_body, tree.step.pose);
  readVelocity(*tree.multi_body, tree.step.start);
  placeLinks(tree, tree.step.start);
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
  const bool has_rows = tree.step.outcome == TreeOutcome::kRows;
  const auto floats = [](const AmbientBody& ambient) { return ambient.surface() != nullptr; };
  const bool is_carried = !has_rows || isOfAny(tree, floats);
  const bool is_unsteady = isOfAny(tree, [](const auto& ambient) { return !ambient.may_rest; });
  if (is_unsteady || (is_carried && moves(tree)) || (!has_rows && standsOnSaddle(tree)))
    tree.multi_body->wakeUp();
}

AMBIENT_END
