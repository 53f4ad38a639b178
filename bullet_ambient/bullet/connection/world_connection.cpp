#include "bullet_ambient/bullet/connection/world_connection.h"

#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolverMt.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorldMt.h>
#include <BulletDynamics/Dynamics/btSimulationIslandManagerMt.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyMLCPConstraintSolver.h>

#include <new>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <typeinfo>
#include <utility>
#include <vector>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/bullet/members/ambient_bodies.h"
#include "bullet_ambient/bullet/solver/fluid_solver.h"

AMBIENT_BEGIN

/// Solvers of a fluid that replace a world's plain ones: one solver, or a pool, and the one for
/// large islands of a multithreaded world. They continue the random numbers of the replaced ones.
class FittedSolvers {
 public:
  /// Makes the solvers; does not change the world.
  /// @throws std::invalid_argument, in one sentence that names makeSolver(), if the world has
  /// another solver than Bullet's plain ones, or a pool of others.
  FittedSolvers(btDiscreteDynamicsWorld& world, const std::shared_ptr<AmbientBodies>& members,
                SolverOwner owner);
  /// Deletes the solvers that nobody else has deleted.
  ~FittedSolvers();
  FittedSolvers(const FittedSolvers&) = delete;
  FittedSolvers& operator=(const FittedSolvers&) = delete;

  /// Gives the solvers to the world.
  void install(btDiscreteDynamicsWorld& world);
  /// Gives the world its own solvers back. A solver that somebody has given the world meanwhile
  /// stays.
  void giveBack(btDiscreteDynamicsWorld& world);
  /// True if the world solves with these solvers. Cost: a comparison of addresses.
  bool areIn(btDiscreteDynamicsWorld& world) const;

 private:
  struct DeleteIfAlive {
    std::weak_ptr<const void> life;
    void operator()(btConstraintSolver* solver) const;
  };
  using MadeSolver = std::unique_ptr<btConstraintSolver, DeleteIfAlive>;
  template <class Made>
  static MadeSolver hold(std::unique_ptr<Made> made);
  static MadeSolver makeFor(btDiscreteDynamicsWorld& world,
                            const std::shared_ptr<AmbientBodies>& members);

  // Solvers for all islands, and for large ones in multithreaded worlds; those of before, which may
  // have been deleted.
  MadeSolver made_, made_large_;
  btConstraintSolver* given_ = nullptr;
  btConstraintSolver* given_large_ = nullptr;
  bool owns_given_ = false;  // the world had made it itself
  SolverOwner owner_;
};

namespace {

using Members = std::shared_ptr<AmbientBodies>;

// Lends access to members that Bullet keeps for derived worlds.
struct OwnedSolver : btDiscreteDynamicsWorld {
  using btDiscreteDynamicsWorld::m_ownsConstraintSolver;
};
constexpr auto kOwnsSolver = &OwnedSolver::m_ownsConstraintSolver;
struct LargeIslandSolver : btDiscreteDynamicsWorldMt {
  using btDiscreteDynamicsWorldMt::m_constraintSolverMt;
};
constexpr auto kLargeIslandSolver = &LargeIslandSolver::m_constraintSolverMt;

int solverCount(const btConstraintSolverPoolMt& pool);
const btConstraintSolver* solverAt(const btConstraintSolverPoolMt& pool, int index);

// Bullet has no accessor for the solvers; NumberReader says why this is allowed.
template <auto kSolvers>
struct PoolReader {
  friend int solverCount(const btConstraintSolverPoolMt& pool) { return (pool.*kSolvers).size(); }
  friend const btConstraintSolver* solverAt(const btConstraintSolverPoolMt& pool, int index) {
    return (pool.*kSolvers)[index].solver;
  }
};
template struct PoolReader<&btConstraintSolverPoolMt::m_solvers>;

btMLCPSolverInterface* algorithmOf(const btMultiBodyMLCPConstraintSolver& solver);

template <auto kAlgorithm>
struct AlgorithmReader {
  friend btMLCPSolverInterface* algorithmOf(const btMultiBodyMLCPConstraintSolver& solver) {
    return solver.*kAlgorithm;
  }
};
template struct AlgorithmReader<&btMultiBodyMLCPConstraintSolver::m_solver>;

// A pool that tells when it is destroyed.
class FluidPool : public btConstraintSolverPoolMt {
 public:
  using btConstraintSolverPoolMt::btConstraintSolverPoolMt;
  std::weak_ptr<const void> life() const { return life_; }

 private:
  std::shared_ptr<const void> life_ = std::make_shared<char>();
};

[[noreturn]] void refuse(const std::string& what, const std::string& use) {
  throw std::invalid_argument("Fluid: " + what + "; " + use);
}

template <class Base>
const Base& requirePlain(const btConstraintSolver* solver) {
  if (solver && typeid(*solver) == typeid(Base)) return static_cast<const Base&>(*solver);
  const std::string word = std::is_same_v<Base, btMultiBodyConstraintSolver>
                               ? "btMultiBodyConstraintSolver"
                           : std::is_same_v<Base, btSequentialImpulseConstraintSolverMt>
                               ? "btSequentialImpulseConstraintSolverMt for large islands"
                               : "btSequentialImpulseConstraintSolver";
  refuse("the world has another solver than a plain " + word,
         "give it that one, make the Fluid, and then give the world makeSolver<Base>(fluid)");
}

template <class Base, class... Args>
std::unique_ptr<FluidSolver<Base>> makeLike(const Base& plain, const Members& members,
                                            Args... args) {
  auto made = std::make_unique<FluidSolver<Base>>(members, args...);
  auto& given = const_cast<Base&>(plain);  // Bullet's accessors are not const
  made->setRandSeed(given.getRandSeed());
  made->setConstraintRowSolverGeneric(given.getActiveConstraintRowSolverGeneric());
  made->setConstraintRowSolverLowerLimit(given.getActiveConstraintRowSolverLowerLimit());
  return made;
}

std::unique_ptr<FluidPool> makePool(const btConstraintSolverPoolMt& pool, const Members& members) {
  std::vector<std::unique_ptr<btConstraintSolver>> made;
  std::vector<btConstraintSolver*> solvers;
  for (int i = 0; i < solverCount(pool); ++i) {
    made.push_back(
        makeLike(requirePlain<btSequentialImpulseConstraintSolver>(solverAt(pool, i)), members));
    solvers.push_back(made.back().get());
  }
  auto result = std::make_unique<FluidPool>(solvers.data(), static_cast<int>(solvers.size()));
  for (auto& solver : made) solver.release();  // the pool deletes them
  return result;
}

void set(btDiscreteDynamicsWorld& world, btConstraintSolver* solver) {
  if (auto* multi_bodies = dynamic_cast<btMultiBodyDynamicsWorld*>(&world)) {
    multi_bodies->setMultiBodyConstraintSolver(static_cast<btMultiBodyConstraintSolver*>(solver));
  } else {
    world.setConstraintSolver(solver);
  }
}

}  // namespace

void FittedSolvers::DeleteIfAlive::operator()(btConstraintSolver* solver) const {
  if (!life.expired()) delete solver;
}

template <class Made>
FittedSolvers::MadeSolver FittedSolvers::hold(std::unique_ptr<Made> made) {
  const DeleteIfAlive deleter{made->life()};
  return MadeSolver(made.release(), deleter);
}

FittedSolvers::MadeSolver FittedSolvers::makeFor(btDiscreteDynamicsWorld& world,
                                                 const Members& members) {
  const btConstraintSolver* given = world.getConstraintSolver();
  if (dynamic_cast<btMultiBodyDynamicsWorld*>(&world)) {
    if (given && typeid(*given) == typeid(btMultiBodyMLCPConstraintSolver)) {
      const auto& plain = static_cast<const btMultiBodyMLCPConstraintSolver&>(*given);
      return hold(makeLike(plain, members, algorithmOf(plain)));
    }
    return hold(makeLike(requirePlain<btMultiBodyConstraintSolver>(given), members));
  }
  if (const auto* pool = dynamic_cast<const btConstraintSolverPoolMt*>(given))
    return hold(makePool(*pool, members));
  return hold(makeLike(requirePlain<btSequentialImpulseConstraintSolver>(given), members));
}

FittedSolvers::FittedSolvers(btDiscreteDynamicsWorld& world, const Members& members,
                             SolverOwner owner)
    : made_(makeFor(world, members)), given_(world.getConstraintSolver()), owner_(owner) {
  if (const auto* multithreaded = dynamic_cast<btDiscreteDynamicsWorldMt*>(&world))
    given_large_ = multithreaded->*kLargeIslandSolver;
  if (!given_large_) return;
  made_large_ =
      hold(makeLike(requirePlain<btSequentialImpulseConstraintSolverMt>(given_large_), members));
}

void FittedSolvers::install(btDiscreteDynamicsWorld& world) {
  if (made_large_)
    dynamic_cast<btDiscreteDynamicsWorldMt&>(world).*kLargeIslandSolver = made_large_.get();
  // Bullet would free the memory of a solver that it has made.
  owns_given_ = std::exchange(world.*kOwnsSolver, false);
  set(world, made_.get());
}

FittedSolvers::~FittedSolvers() {
  if (owner_ == SolverOwner::kAsksWorld && made_.get_deleter().life.expired()) {
    delete given_;
    return;
  }
  if (!owns_given_) return;
  given_->~btConstraintSolver();
  btAlignedFree(given_);
}

void FittedSolvers::giveBack(btDiscreteDynamicsWorld& world) {
  if (areIn(world)) {
    set(world, given_);
    world.*kOwnsSolver = std::exchange(owns_given_, false);
  }
  auto* multithreaded = dynamic_cast<btDiscreteDynamicsWorldMt*>(&world);
  if (multithreaded && made_large_ && multithreaded->*kLargeIslandSolver == made_large_.get())
    multithreaded->*kLargeIslandSolver = given_large_;
}

// A solver that somebody else has deleted may have its address in use again.
bool FittedSolvers::areIn(btDiscreteDynamicsWorld& world) const {
  return world.getConstraintSolver() == made_.get() && !made_.get_deleter().life.expired();
}

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
