#include "bullet_ambient/bullet/world_tie.h"

#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorldMt.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>

#include <stdexcept>

#include "bullet_ambient/bullet/world_kind.h"

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {

void WorldTie::tie(btDynamicsWorld& world, btConstraintSolver& solver, btActionInterface& action) {
  if (world_ && world_ != &world) {
    throw std::invalid_argument(
        "attachTo: this fluid is attached to another world; take a Fluid for each world, or call "
        "clear() when the other one is gone");
  }
  checkWorldKind("attachTo", world);
  auto* multibody_world = dynamic_cast<btMultiBodyDynamicsWorld*>(&world);
  auto* multibody_solver = dynamic_cast<btMultiBodyConstraintSolver*>(&solver);
  if (multibody_world && !multibody_solver) {
    throw std::invalid_argument(
        "attachTo: btMultiBodyDynamicsWorld needs a solver of multibodies; use "
        "Fluid<btMultiBodyConstraintSolver>");
  }
  if (!multibody_world && multibody_solver) {
    throw std::invalid_argument(
        "attachTo: btMultiBodyConstraintSolver needs a btMultiBodyDynamicsWorld: elsewhere Bullet "
        "reads members that nothing has set; use Fluid<>");
  }
  if (multibody_world) {
    multibody_world->setMultiBodyConstraintSolver(multibody_solver);
  } else if (!dynamic_cast<btConstraintSolverPoolMt*>(world.getConstraintSolver())) {
    world.setConstraintSolver(&solver);
  }
  world.removeAction(&action);  // if the world has it already
  world.addAction(&action);
  world_ = &world;
}

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
