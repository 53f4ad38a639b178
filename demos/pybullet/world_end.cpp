#include "demos/pybullet/world_end.h"

#include <BulletCollision/CollisionDispatch/btSimulationIslandManager.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>

#include <new>
#include <stdexcept>
#include <typeinfo>
#include <utility>

namespace ambient::pybullet {
namespace {

// Lends access to members that Bullet keeps for derived worlds.
struct IslandManagerOwner : btDiscreteDynamicsWorld {
  using btDiscreteDynamicsWorld::m_islandManager;
  using btDiscreteDynamicsWorld::m_ownsIslandManager;
};
constexpr auto kIslandManager = &IslandManagerOwner::m_islandManager;
constexpr auto kOwnsIslandManager = &IslandManagerOwner::m_ownsIslandManager;

// Destroys an island manager as Bullet's worlds do.
void destroy(btSimulationIslandManager* manager) {
  manager->~btSimulationIslandManager();
  btAlignedFree(manager);
}

}  // namespace

struct WorldEnd::Watch {
  /// Island manager of the world that tells.
  class Manager final : public btSimulationIslandManager {
   public:
    explicit Manager(std::shared_ptr<Watch> watch) : watch_(std::move(watch)) {}
    Manager(const Manager&) = delete;
    Manager& operator=(const Manager&) = delete;
    ~Manager() override {
      if (!watch_->given) return;  // given back before
      destroy(std::exchange(watch_->given, nullptr));
      watch_->tell();
    }

   private:
    const std::shared_ptr<Watch> watch_;
  };

  btSimulationIslandManager* given;  ///< the world's own; null: the world has ended
  std::function<void()> tell;
};

WorldEnd::WorldEnd(btDiscreteDynamicsWorld& world, std::function<void()> tell) : world_(world) {
  constexpr int kAlignment = 16;  // as Bullet's worlds allocate theirs
  btSimulationIslandManager& given = *(world.*kIslandManager);
  if (!(world.*kOwnsIslandManager) || typeid(given) != typeid(btSimulationIslandManager))
    throw std::invalid_argument("the world has an island manager of a class of its own");
  watch_ = std::make_shared<Watch>(Watch{&given, std::move(tell)});
  auto* manager = new (btAlignedAlloc(sizeof(Watch::Manager), kAlignment)) Watch::Manager(watch_);
  manager->setSplitIslands(given.getSplitIslands());
  world.*kIslandManager = manager;
}

WorldEnd::~WorldEnd() {
  if (!watch_->given) return;
  btSimulationIslandManager* manager = world_.*kIslandManager;
  watch_->given->setSplitIslands(manager->getSplitIslands());
  world_.*kIslandManager = std::exchange(watch_->given, nullptr);
  destroy(manager);
}

}  // namespace ambient::pybullet
