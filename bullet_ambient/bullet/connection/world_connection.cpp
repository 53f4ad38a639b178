#include "bullet_ambient/bullet/connection/world_connection.h"

#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>

#include <stdexcept>
#include <string>
#include <utility>

#include "bullet_ambient/bullet/connection/fitted_solvers.h"
#include "bullet_ambient/bullet/connection/world_life.h"

AMBIENT_BEGIN
namespace {

btDiscreteDynamicsWorld& requireKind(btDynamicsWorld& world) {
  if (world.getWorldType() == BT_DEFORMABLE_MULTIBODY_DYNAMICS_WORLD) {
    throw std::invalid_argument(
        "Fluid: btDeformableMultiBodyDynamicsWorld solves rigid bodies together with deformable "
        "ones in a way that cannot be rewritten; use btSoftRigidDynamicsWorld or "
        "btMultiBodyDynamicsWorld");
  }
  auto* discrete = dynamic_cast<btDiscreteDynamicsWorld*>(&world);
  if (discrete) return *discrete;
  throw std::invalid_argument(
      "Fluid: btSimpleDynamicsWorld hands no bodies to its solver, so that no fluid can act; use "
      "btDiscreteDynamicsWorld");
}

}  // namespace

WorldConnection::WorldConnection(btDynamicsWorld& world,
                                 const std::shared_ptr<AmbientBodies>& members,
                                 btActionInterface& action, SolverOwner owner)
    : world_(&requireKind(world)),
      action_(action),
      owner_(owner),
      life_(std::make_shared<WorldLife>()) {
  life_->members = members;
  solvers_ = std::make_unique<FittedSolvers>(*world_, members, owner);
  watch(*world_, life_);
  solvers_->install(*world_);
  world_->addAction(&action_);
}

WorldConnection::~WorldConnection() {
  if (life_->has_ended) return;
  world_->removeAction(&action_);
  stopWatching(*world_, *life_);
  solvers_->giveBack(*world_);
}

bool WorldConnection::isWorldAlive() const { return !life_->has_ended; }

void WorldConnection::refit() {
  btDiscreteDynamicsWorld& its = world("refit");
  if (solvers_->areIn(its)) return;
  auto fitting = std::make_unique<FittedSolvers>(its, life_->members.lock(), owner_);
  solvers_ = std::move(fitting);
  solvers_->install(its);
}

btDiscreteDynamicsWorld& WorldConnection::world(const char* who) const {
  if (!life_->has_ended) return *world_;
  throw std::logic_error(std::string(who) +
                         ": the world of this Fluid was destroyed; make a new Fluid for a new one");
}

btMultiBodyDynamicsWorld& WorldConnection::multiBodyWorld(const char* who) const {
  if (auto* multi_bodies = dynamic_cast<btMultiBodyDynamicsWorld*>(&world(who)))
    return *multi_bodies;
  throw std::invalid_argument(std::string(who) +
                              ": links of a btMultiBody move in a btMultiBodyDynamicsWorld only");
}

AMBIENT_END
