#include "bullet_ambient/bullet/connection/world_life.h"

#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btSimulationIslandManagerMt.h>

#include <new>
#include <stdexcept>
#include <type_traits>
#include <typeinfo>
#include <utility>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/bullet/members/ambient_bodies.h"

AMBIENT_BEGIN
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

}  // namespace

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

AMBIENT_END
