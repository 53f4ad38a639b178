#include "bullet_ambient/bullet/connection/world_connection.h"

#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btSimulationIslandManagerMt.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>

#include <new>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <typeinfo>
#include <utility>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/bullet/connection/fitted_solvers.h"
#include "bullet_ambient/bullet/members/ambient_bodies.h"

AMBIENT_BEGIN

/// Says whether a world is alive. When the world is destroyed, all members leave their fluid.
struct WorldLife {
  std::weak_ptr<AmbientBodies> members;
  btSimulationIslandManager* given = nullptr;  ///< the world's own island manager
  bool has_ended = false;
};

namespace {

// Lends access to members that Bullet keeps for derived worlds.
struct IslandManagerOwner : btDiscreteDynamicsWorld {
  using btDiscreteDynamicsWorld::m_islandManager;
  using btDiscreteDynamicsWorld::m_ownsIslandManager;
};
constexpr auto kIslandManager = &IslandManagerOwner::m_islandManager;
constexpr auto kOwnsIslandManager = &IslandManagerOwner::m_ownsIslandManager;

void copySettings(btSimulationIslandManager& from, btSimulationIslandManager& to) {
  to.setSplitIslands(from.getSplitIslands());
}

void copySettings(btSimulationIslandManagerMt& from, btSimulationIslandManagerMt& to) {
  to.setSplitIslands(from.getSplitIslands());
  to.setMinimumSolverBatchSize(from.getMinimumSolverBatchSize());
  to.setIslandDispatchFunction(from.getIslandDispatchFunction());
}

// Destroys an island manager like Bullet's worlds do.
void destroy(btSimulationIslandManager* manager) {
  manager->~btSimulationIslandManager();
  btAlignedFree(manager);
}

template <class Manager>
class WatchingManager final : public Manager {
 public:
  WatchingManager(Manager& given, std::shared_ptr<WorldLife> life) : life_(std::move(life)) {
    copySettings(given, *this);
  }
  WatchingManager(const WatchingManager&) = delete;
  WatchingManager& operator=(const WatchingManager&) = delete;
  ~WatchingManager() override {
    if (!life_->given) return;  // stopWatching() has given it back
    destroy(std::exchange(life_->given, nullptr));
    life_->has_ended = true;
    const auto members = life_->members.lock();
    if (!members) return;
    members->clear();
    members->is_closed = true;
  }

 private:
  const std::shared_ptr<WorldLife> life_;
};

template <class Manager>
btSimulationIslandManager* makeWatching(btSimulationIslandManager& given,
                                        const std::shared_ptr<WorldLife>& life) {
  constexpr int kAlignment = 16;  // as Bullet's worlds allocate theirs
  void* memory = btAlignedAlloc(sizeof(WatchingManager<Manager>), kAlignment);
  return new (memory) WatchingManager<Manager>(static_cast<Manager&>(given), life);
}

/// Begins to watch a world: replaces its island manager by one that works alike and reports its
/// destruction.
/// @throws std::invalid_argument if the world has an island manager of a class of its own.
void watch(btDiscreteDynamicsWorld& world, const std::shared_ptr<WorldLife>& life) {
  btSimulationIslandManager& given = *(world.*kIslandManager);
  const bool is_plain = typeid(given) == typeid(btSimulationIslandManager);
  const bool is_multithreaded = typeid(given) == typeid(btSimulationIslandManagerMt);
  if (!(world.*kOwnsIslandManager) || !(is_plain || is_multithreaded)) {
    throw std::invalid_argument(
        "Fluid: the world has an island manager of a class of its own; a fluid needs one of "
        "Bullet's to know when the world is destroyed");
  }
  world.*kIslandManager = is_plain ? makeWatching<btSimulationIslandManager>(given, life)
                                   : makeWatching<btSimulationIslandManagerMt>(given, life);
  life->given = &given;
}

/// Gives the world its own island manager back. @pre the world is alive
void stopWatching(btDiscreteDynamicsWorld& world, WorldLife& life) {
  btSimulationIslandManager* watching = world.*kIslandManager;
  AMBIENT_ASSERT(watching);
  btSimulationIslandManager* given = std::exchange(life.given, nullptr);
  auto* multithreaded = dynamic_cast<btSimulationIslandManagerMt*>(watching);
  if (multithreaded) {
    copySettings(*multithreaded, static_cast<btSimulationIslandManagerMt&>(*given));
  } else {
    copySettings(*watching, *given);
  }
  world.*kIslandManager = given;
  destroy(watching);
}

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
