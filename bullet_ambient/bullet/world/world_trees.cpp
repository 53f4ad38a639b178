#include "bullet_ambient/bullet/world/world_trees.h"

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>

#include "bullet_ambient/bullet/links/tree_links.h"
#include "bullet_ambient/bullet/links/tree_motion.h"
#include "bullet_ambient/bullet/members/attach_link.h"
#include "bullet_ambient/bullet/members/tree_state.h"
#include "bullet_ambient/bullet/world/fluid_drawing.h"

AMBIENT_BEGIN
namespace {

bool isOf(const btCollisionWorld& world, const AmbientTrees& trees) {
  return !trees.empty() && trees.world() == &world;
}

}  // namespace

bool hasAwakeTree(const btCollisionWorld& world, const AmbientBodies& bodies) noexcept {
  if (!isOf(world, bodies.trees)) return false;
  bool is_awake = false;
  forEachTree(*bodies.trees.world(), bodies.trees,
              [&is_awake](const AmbientTree& tree) { is_awake |= !isAsleep(*tree.multi_body); });
  return is_awake;
}

void wakeFollowingTrees(const btCollisionWorld& world, const AmbientBodies& bodies) noexcept {
  if (!isOf(world, bodies.trees)) return;
  forEachTree(*bodies.trees.world(), bodies.trees, [](const AmbientTree& tree) {
    for (const auto& link : tree.links)
      if (link->ambient.def->follow_regions) return wake(*tree.multi_body);
  });
}

void wakeReloadedTrees(const btCollisionWorld& world, const AmbientBodies& bodies) noexcept {
  if (!isOf(world, bodies.trees)) return;
  forEachTree(*bodies.trees.world(), bodies.trees, [](const AmbientTree& tree) {
    if (!isAsleep(*tree.multi_body)) return;
    for (const auto& link : tree.links)
      if (isReloaded(*link, *tree.multi_body)) return wake(*tree.multi_body);
  });
}

void drawTrees(const btCollisionWorld& world, const AmbientBodies& bodies, const FluidDrawing& what,
               btIDebugDraw& drawer) {
  if (!isOf(world, bodies.trees)) return;
  forEachTree(*bodies.trees.world(), bodies.trees, [&](AmbientTree& tree) {
    moveStandIns(tree);
    for (const auto& link : tree.links) {
      const bool is_in_fluid =
          link->ambient.isInFluid() && !link->stand_in.isStaticOrKinematicObject();
      if (is_in_fluid) drawFluid(link->ambient, what, drawer);
    }
  });
}

void completeTrees(const btCollisionWorld& world, AmbientBodies& bodies,
                   double time_step) noexcept {
  if (!isOf(world, bodies.trees)) return;
  const TreeTask task = taskOf(bodies, static_cast<btScalar>(time_step));
  forEachTree(*bodies.trees.world(), bodies.trees,
              [&task](AmbientTree& tree) { completeTree(tree, task); });
  for (const auto& tree : bodies.trees.all()) tree->step.outcome = TreeOutcome::kNotMet;
}

AMBIENT_END
