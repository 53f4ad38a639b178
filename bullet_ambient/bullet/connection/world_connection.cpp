#include "bullet_ambient/bullet/connection/world_connection.h"

#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyMLCPConstraintSolver.h>

#include <stdexcept>
#include <string>
#include <type_traits>
#include <typeinfo>
#include <utility>

#include "bullet_ambient/bullet/members/ambient_bodies.h"
#include "bullet_ambient/bullet/solver/fluid_solver.h"

AMBIENT_BEGIN

/// Solver of a fluid that replaces a plain one of a world, and continues its random numbers.
class FittedSolver {
 public:
  /// Makes the solver; does not change the world.
  /// @throws std::invalid_argument, in one sentence that names makeSolver(), if the world has
  /// another solver than Bullet's plain ones.
  FittedSolver(btDiscreteDynamicsWorld& world, const std::shared_ptr<AmbientBodies>& members,
               SolverOwner owner);
  /// Deletes the solver unless somebody else has.
  ~FittedSolver();
  FittedSolver(const FittedSolver&) = delete;
  FittedSolver& operator=(const FittedSolver&) = delete;

  /// Gives the solver to the world.
  void install(btDiscreteDynamicsWorld& world);
  /// Gives the world its own solver back. A solver that somebody has given the world meanwhile
  /// stays.
  void giveBack(btDiscreteDynamicsWorld& world);
  /// True if the world solves with this solver. Cost: a comparison of addresses.
  bool isIn(btDiscreteDynamicsWorld& world) const;

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

  MadeSolver made_;
  btConstraintSolver* given_;  // that of before, which may have been deleted
  bool owns_given_ = false;    // the world had made it itself
  SolverOwner owner_;
};

namespace {

using Members = std::shared_ptr<AmbientBodies>;

// Lends access to members that Bullet keeps for derived worlds.
struct OwnedSolver : btDiscreteDynamicsWorld {
  using btDiscreteDynamicsWorld::m_ownsConstraintSolver;
};
constexpr auto kOwnsSolver = &OwnedSolver::m_ownsConstraintSolver;

btMLCPSolverInterface* algorithmOf(const btMultiBodyMLCPConstraintSolver& solver);

// Bullet has no accessor for the algorithm; NumberReader says why this is allowed.
template <auto kAlgorithm>
struct AlgorithmReader {
  friend btMLCPSolverInterface* algorithmOf(const btMultiBodyMLCPConstraintSolver& solver) {
    return solver.*kAlgorithm;
  }
};
template struct AlgorithmReader<&btMultiBodyMLCPConstraintSolver::m_solver>;

[[noreturn]] void refuse(const std::string& what, const std::string& use) {
  throw std::invalid_argument("Fluid: " + what + "; " + use);
}

template <class Base>
const Base& requirePlain(const btConstraintSolver* solver) {
  if (solver && typeid(*solver) == typeid(Base)) return static_cast<const Base&>(*solver);
  const std::string word = std::is_same_v<Base, btMultiBodyConstraintSolver>
                               ? "btMultiBodyConstraintSolver"
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

void set(btDiscreteDynamicsWorld& world, btConstraintSolver* solver) {
  if (auto* multi_bodies = dynamic_cast<btMultiBodyDynamicsWorld*>(&world)) {
    multi_bodies->setMultiBodyConstraintSolver(static_cast<btMultiBodyConstraintSolver*>(solver));
  } else {
    world.setConstraintSolver(solver);
  }
}

}  // namespace

void FittedSolver::DeleteIfAlive::operator()(btConstraintSolver* solver) const {
  if (!life.expired()) delete solver;
}

template <class Made>
FittedSolver::MadeSolver FittedSolver::hold(std::unique_ptr<Made> made) {
  const DeleteIfAlive deleter{made->life()};
  return MadeSolver(made.release(), deleter);
}

FittedSolver::MadeSolver FittedSolver::makeFor(btDiscreteDynamicsWorld& world,
                                               const Members& members) {
  const btConstraintSolver* given = world.getConstraintSolver();
  if (dynamic_cast<btMultiBodyDynamicsWorld*>(&world)) {
    if (given && typeid(*given) == typeid(btMultiBodyMLCPConstraintSolver)) {
      const auto& plain = static_cast<const btMultiBodyMLCPConstraintSolver&>(*given);
      return hold(makeLike(plain, members, algorithmOf(plain)));
    }
    return hold(makeLike(requirePlain<btMultiBodyConstraintSolver>(given), members));
  }
  return hold(makeLike(requirePlain<btSequentialImpulseConstraintSolver>(given), members));
}

FittedSolver::FittedSolver(btDiscreteDynamicsWorld& world, const Members& members,
                           SolverOwner owner)
    : made_(makeFor(world, members)), given_(world.getConstraintSolver()), owner_(owner) {}

void FittedSolver::install(btDiscreteDynamicsWorld& world) {
  // Bullet would free the memory of a solver that it has made.
  owns_given_ = std::exchange(world.*kOwnsSolver, false);
  set(world, made_.get());
}

FittedSolver::~FittedSolver() {
  if (owner_ == SolverOwner::kAsksWorld && made_.get_deleter().life.expired()) {
    delete given_;
    return;
  }
  if (!owns_given_) return;
  given_->~btConstraintSolver();
  btAlignedFree(given_);
}

void FittedSolver::giveBack(btDiscreteDynamicsWorld& world) {
  if (!isIn(world)) return;
  set(world, given_);
  world.*kOwnsSolver = std::exchange(owns_given_, false);
}

// A solver that somebody else has deleted may have its address in use again.
bool FittedSolver::isIn(btDiscreteDynamicsWorld& world) const {
  return world.getConstraintSolver() == made_.get() && !made_.get_deleter().life.expired();
}

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
    : world_(requireKind(world)),
      action_(action),
      owner_(owner),
      members_(members),
      solver_(std::make_unique<FittedSolver>(world_, members, owner)) {
  solver_->install(world_);
  world_.addAction(&action_);
}

WorldConnection::~WorldConnection() {
  world_.removeAction(&action_);
  solver_->giveBack(world_);
}

void WorldConnection::refit() {
  if (solver_->isIn(world_)) return;
  auto fitting = std::make_unique<FittedSolver>(world_, members_, owner_);
  solver_ = std::move(fitting);
  solver_->install(world_);
}

btMultiBodyDynamicsWorld& WorldConnection::multiBodyWorld(const char* who) const {
  if (auto* multi_bodies = dynamic_cast<btMultiBodyDynamicsWorld*>(&world_)) return *multi_bodies;
  throw std::invalid_argument(std::string(who) +
                              ": links of a btMultiBody move in a btMultiBodyDynamicsWorld only");
}

AMBIENT_END
