#include "bullet_ambient/bullet/connection/world_connection.h"

#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorldMt.h>
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
std::unique_ptr<FluidSolver<Base>> makeLike(const Base& plain, const Members& bodies,
                                            Args... args) {
  auto made = std::make_unique<FluidSolver<Base>>(bodies, args...);
  auto& given = const_cast<Base&>(plain);  // Bullet's accessors are not const
  made->setRandSeed(given.getRandSeed());
  made->setConstraintRowSolverGeneric(given.getActiveConstraintRowSolverGeneric());
  made->setConstraintRowSolverLowerLimit(given.getActiveConstraintRowSolverLowerLimit());
  return made;
}

void setSolver(btDiscreteDynamicsWorld& world, btConstraintSolver* solver) {
  if (auto* multi_bodies = dynamic_cast<btMultiBodyDynamicsWorld*>(&world)) {
    multi_bodies->setMultiBodyConstraintSolver(static_cast<btMultiBodyConstraintSolver*>(solver));
  } else {
    world.setConstraintSolver(solver);
  }
}

btDiscreteDynamicsWorld& requireKind(btDynamicsWorld& world) {
  if (world.getWorldType() == BT_DEFORMABLE_MULTIBODY_DYNAMICS_WORLD) {
    throw std::invalid_argument(
        "Fluid: btDeformableMultiBodyDynamicsWorld solves rigid bodies together with deformable "
        "ones in a way that cannot be rewritten; use btSoftRigidDynamicsWorld or "
        "btMultiBodyDynamicsWorld");
  }
  const auto* threaded = dynamic_cast<btDiscreteDynamicsWorldMt*>(&world);
  if (threaded && threaded->*kLargeIslandSolver)
    refuse("the world has a solver of its own for large islands, in which no fluid would act",
           "make the btDiscreteDynamicsWorldMt with null in its place");
  auto* discrete = dynamic_cast<btDiscreteDynamicsWorld*>(&world);
  if (discrete) return *discrete;
  throw std::invalid_argument(
      "Fluid: btSimpleDynamicsWorld hands no bodies to its solver, so that no fluid can act; use "
      "btDiscreteDynamicsWorld");
}

}  // namespace

void WorldConnection::DeleteIfAlive::operator()(btConstraintSolver* solver) const {
  if (!life.expired()) delete solver;
}

WorldConnection::MadeSolver WorldConnection::makeFitting() const {
  const auto hold = [](auto made) {
    const DeleteIfAlive deleter{made->life()};
    return MadeSolver(made.release(), deleter);
  };
  const btConstraintSolver* given = world_.getConstraintSolver();
  if (!dynamic_cast<btMultiBodyDynamicsWorld*>(&world_))
    return hold(makeLike(requirePlain<btSequentialImpulseConstraintSolver>(given), bodies_));
  if (!given || typeid(*given) != typeid(btMultiBodyMLCPConstraintSolver))
    return hold(makeLike(requirePlain<btMultiBodyConstraintSolver>(given), bodies_));
  const auto& plain = static_cast<const btMultiBodyMLCPConstraintSolver&>(*given);
  return hold(makeLike(plain, bodies_, algorithmOf(plain)));
}

WorldConnection::WorldConnection(btDynamicsWorld& world,
                                 const std::shared_ptr<AmbientBodies>& bodies,
                                 btActionInterface& action, SolverOwner owner)
    : world_(requireKind(world)),
      is_threaded_(dynamic_cast<btDiscreteDynamicsWorldMt*>(&world)),
      action_(action),
      owner_(owner),
      bodies_(bodies) {
  install(makeFitting());
  world_.addAction(&action_);
}

WorldConnection::~WorldConnection() {
  world_.removeAction(&action_);
  if (isFitted()) {
    setSolver(world_, given_);
    world_.*kOwnsSolver = std::exchange(owns_given_, false);
  }
  dropGiven();
}

void WorldConnection::refit() {
  if (isFitted()) return;
  MadeSolver fitting = makeFitting();
  dropGiven();
  install(std::move(fitting));
}

void WorldConnection::install(MadeSolver solver) {
  made_ = std::move(solver);
  given_ = world_.getConstraintSolver();
  // Bullet would free the memory of a solver that it has made.
  owns_given_ = std::exchange(world_.*kOwnsSolver, false);
  setSolver(world_, made_.get());
}

void WorldConnection::dropGiven() {
  if (owner_ == SolverOwner::kAsksWorld && made_.get_deleter().life.expired()) {
    delete given_;
  } else if (owns_given_) {
    given_->~btConstraintSolver();
    btAlignedFree(given_);
  }
}

// A solver that somebody else has deleted may have its address in use again.
bool WorldConnection::isFitted() const {
  return world_.getConstraintSolver() == made_.get() && !made_.get_deleter().life.expired();
}

btMultiBodyDynamicsWorld& WorldConnection::multiBodyWorld(const char* who) const {
  if (auto* multi_bodies = dynamic_cast<btMultiBodyDynamicsWorld*>(&world_)) return *multi_bodies;
  throw std::invalid_argument(std::string(who) +
                              ": links of a btMultiBody move in a btMultiBodyDynamicsWorld only");
}

AMBIENT_END
