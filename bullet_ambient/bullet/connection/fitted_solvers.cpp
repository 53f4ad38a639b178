#include "bullet_ambient/bullet/connection/fitted_solvers.h"

#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolverMt.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorldMt.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyMLCPConstraintSolver.h>

#include <stdexcept>
#include <string>
#include <type_traits>
#include <typeinfo>
#include <utility>
#include <vector>

#include "bullet_ambient/bullet/solver/fluid_solver.h"

AMBIENT_BEGIN
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

AMBIENT_END
