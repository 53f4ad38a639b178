#include "bullet_ambient/bullet/world_tie.h"

#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorldMt.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>

#include <stdexcept>

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {

void checkWorldKind(const std::string& who, const btDynamicsWorld& world) {
  switch (world.getWorldType()) {
    case BT_SIMPLE_DYNAMICS_WORLD:
      throw std::invalid_argument(
          who +
          ": btSimpleDynamicsWorld hands no bodies to its solver, so that no fluid can act; "
          "use btDiscreteDynamicsWorld");
    case BT_DEFORMABLE_MULTIBODY_DYNAMICS_WORLD:
      throw std::invalid_argument(
          who +
          ": btDeformableMultiBodyDynamicsWorld solves rigid bodies together with deformable "
          "ones in a way that cannot be rewritten; use btSoftRigidDynamicsWorld or "
          "btMultiBodyDynamicsWorld");
    default:
      return;
  }
}

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
  multibody_world_ = multibody_world;
}

btMultiBodyDynamicsWorld& WorldTie::multiBodyWorld() const {
  if (multibody_world_) return *multibody_world_;
  throw std::invalid_argument(
      world_ ? "add: links of a btMultiBody move in a btMultiBodyDynamicsWorld only"
             : "add: links of a btMultiBody need to know their world; call attachTo(world) first");
}

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
