#include "bullet_ambient/bullet/reading/tree_reading.h"

#include <algorithm>

#include "bullet_ambient/bullet/members/tree_state.h"
#include "bullet_ambient/bullet/reading/fluid_reading.h"

AMBIENT_BEGIN
namespace {

bool isRead(const AmbientTree& tree) {
  return std::any_of(tree.links.begin(), tree.links.end(),
                     [](const auto& link) { return link->ambient.reading != nullptr; });
}

template <class Visit>
void forEachRead(const AmbientTree& tree, const Visit& visit) {
  for (const auto& link : tree.links) {
    const Link& in_tree = tree.tree.links[link->link + 1];
    if (link->ambient.reading && in_tree.model) visit(link->ambient, link->link + 1);
  }
}

RigidState stateOf(const LinkDynamics& dynamics, int link) {
  return {Quaternion(dynamics.rotation(link)), dynamics.position(link), dynamics.twist(link)};
}

/// Whether nothing but the fluid and applied forces have moved it.
bool isFree(const AmbientTree& tree) {
  return tree.tree.size() == 1 && !tree.tree.links.front().keeps_velocity &&
         tree.step.outcome == TreeOutcome::kFlown;
}

}  // namespace

void beginTreeReading(AmbientTree& tree) noexcept {
  if (!isRead(tree)) return;
  LinkDynamics& dynamics = tree.flight.dynamics();
  dynamics.setPose(tree.step.pose);
  dynamics.setVelocity(tree.step.start);
  forEachRead(tree, [&](AmbientBody& ambient, int link) {
    FluidReading& reading = *ambient.reading;
    beginReading(ambient, stateOf(dynamics, link), tree.tree.links[link].surroundings, reading);
    reading.model = *tree.tree.links[link].model;
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
  forEachRead(tree, [&](AmbientBody& ambient, int link) {
    FluidReading& reading = *ambient.reading;
    reading.end = stateOf(dynamics, link);
    reading.knows_impulse = is_free;
    const Matrix3& R = dynamics.rotation(link);
    const Wrench& passage = step.impulses[link];
    if (step.meets_surface) reading.passage_W = {R * passage.torque, R * passage.force};
  });
  movePose(tree.tree, step.pose, step.moved, -duration / 2, step.pose);
  dynamics.setPose(step.pose);
  dynamics.setVelocity(step.moved);
  forEachRead(tree, [&](AmbientBody& ambient, int link) {
    FluidReading& reading = *ambient.reading;
    finishReading(ambient,
                  {stateOf(dynamics, link), reading.end, reading.model,
                   step.outcome == TreeOutcome::kFlown, duration},
                  reading);
  });
}

AMBIENT_END
