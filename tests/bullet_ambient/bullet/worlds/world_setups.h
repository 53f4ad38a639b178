#pragma once

#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorldMt.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>

#include <memory>
#include <string>
#include <type_traits>
#include <utility>

#include "bullet_ambient/bullet/ambient_action.h"
#include "tests/support/solver_kinds.h"

namespace ambient::test {

/// A world as a program sets it up: with Bullet's own solver, or with an ambient solver and action.
class WorldHost {
 public:
  WorldHost() = default;
  WorldHost(const WorldHost&) = delete;
  WorldHost& operator=(const WorldHost&) = delete;
  virtual ~WorldHost() = default;

  virtual btDiscreteDynamicsWorld& world() = 0;
  /// Null if the world does not take such bodies.
  btSoftRigidDynamicsWorld* softWorld() {
    return dynamic_cast<btSoftRigidDynamicsWorld*>(&world());
  }
  btMultiBodyDynamicsWorld* multiBodyWorld() {
    return dynamic_cast<btMultiBodyDynamicsWorld*>(&world());
  }
  void step(double duration, int count = 1) {
    const auto dt = static_cast<btScalar>(duration);
    for (int i = 0; i < count; ++i) world().stepSimulation(dt, 0, dt);
  }

  AmbientRegistry registry;  ///< without bodies where the solver is Bullet's own

 protected:
  btSoftBodyRigidBodyCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  // Not btDbvtBroadphase: when it drops pairs that are apart again depends on how everything else
  // moves, and Bullet merges islands by pairs.
  btSimpleBroadphase broadphase_;
  AmbientAction action_{registry};
};

/// The solver of one kind, constructed from a registry that Bullet's own does not need.
template <class Kind, bool kIsAmbient>
struct SolverHolder : Kind::Ambient {
  explicit SolverHolder(AmbientRegistry& registry) : Kind::Ambient(registry) {}
};
template <class Kind>
struct SolverHolder<Kind, false> : Kind::Stock {
  explicit SolverHolder(AmbientRegistry&) {}
};

template <class Kind, class World, bool kIsAmbient>
class SingleThreadedHost final : public WorldHost {
 public:
  SingleThreadedHost() {
    if (kIsAmbient) world_.addAction(&action_);
  }
  btDiscreteDynamicsWorld& world() override { return world_; }

 private:
  SolverHolder<Kind, kIsAmbient> holder_{registry};
  World world_{&dispatcher_, &broadphase_, &holder_.solver, &configuration_};
};

/// Islands of more than a few contacts go to the multithreaded solver, as large ones do by default.
template <bool kIsAmbient>
class MultithreadedHost final : public WorldHost {
  using Limit = btSequentialImpulseConstraintSolverMt;

 public:
  MultithreadedHost()
      : default_limit_(std::exchange(Limit::s_minimumContactManifoldsForBatching, 3)) {
    if (kIsAmbient) world_.addAction(&action_);
  }
  ~MultithreadedHost() override { Limit::s_minimumContactManifoldsForBatching = default_limit_; }
  btDiscreteDynamicsWorld& world() override { return world_; }

 private:
  template <class Base>
  using Solver = std::conditional_t<kIsAmbient, AmbientSolver<Base>, Base>;

  template <class Base>
  std::unique_ptr<Solver<Base>> make() {
    if constexpr (kIsAmbient) {
      return std::make_unique<Solver<Base>>(registry);
    } else {
      return std::make_unique<Base>();
    }
  }
  struct Pair {
    btConstraintSolver* solvers[2];
  };

  int default_limit_;
  // The pool deletes its solvers.
  Pair pair_{{make<btSequentialImpulseConstraintSolver>().release(),
              make<btSequentialImpulseConstraintSolver>().release()}};
  btConstraintSolverPoolMt pool_{pair_.solvers, 2};
  std::unique_ptr<btConstraintSolver> large_{make<btSequentialImpulseConstraintSolverMt>()};
  btDiscreteDynamicsWorldMt world_{&dispatcher_, &broadphase_, &pool_, large_.get(),
                                   &configuration_};
};

// One type for each world and solver that a program may combine. Bullet's
// btMultiBodyConstraintSolver reads uninitialised members where no btMultiBodyDynamicsWorld calls
// it.

template <class SolverKind, class World>
struct WorldAndSolver {
  using Kind = SolverKind;
  static std::unique_ptr<WorldHost> make(bool is_ambient) {
    if (is_ambient) return std::make_unique<SingleThreadedHost<Kind, World, true>>();
    return std::make_unique<SingleThreadedHost<Kind, World, false>>();
  }
  static std::string name() {
    const std::string world = std::is_same_v<World, btSoftRigidDynamicsWorld>   ? "Soft"
                              : std::is_same_v<World, btMultiBodyDynamicsWorld> ? "MultiBodies"
                                                                                : "Discrete";
    return world + "With" + SolverName::GetName<Kind>(0);
  }
};

template <class Kind>
using InDiscreteWorld = WorldAndSolver<Kind, btDiscreteDynamicsWorld>;
template <class Kind>
using InSoftWorld = WorldAndSolver<Kind, btSoftRigidDynamicsWorld>;
using InMultiBodyWorld = WorldAndSolver<MultiBody, btMultiBodyDynamicsWorld>;

struct InMultithreadedWorld {
  using Kind = Multithreaded;
  static std::unique_ptr<WorldHost> make(bool is_ambient) {
    if (is_ambient) return std::make_unique<MultithreadedHost<true>>();
    return std::make_unique<MultithreadedHost<false>>();
  }
  static std::string name() { return "DiscreteMtWithPool"; }
};

using AllWorlds =
    ::testing::Types<InDiscreteWorld<SequentialImpulse>, InDiscreteWorld<ConjugateGradient>,
                     InDiscreteWorld<Dantzig>, InDiscreteWorld<ProjectedGaussSeidel>,
                     InDiscreteWorld<Lemke>, InDiscreteWorld<Multithreaded>,
                     InSoftWorld<SequentialImpulse>, InSoftWorld<ConjugateGradient>,
                     InMultiBodyWorld, InMultithreadedWorld>;

/// Bullet's Lemke solver cannot do without friction and is wrong where bounds coincide, with fluid
/// or without.
using WorldsWithRestingContacts =
    ::testing::Types<InDiscreteWorld<SequentialImpulse>, InDiscreteWorld<ConjugateGradient>,
                     InDiscreteWorld<Dantzig>, InDiscreteWorld<ProjectedGaussSeidel>,
                     InDiscreteWorld<Multithreaded>, InSoftWorld<SequentialImpulse>,
                     InSoftWorld<ConjugateGradient>, InMultiBodyWorld, InMultithreadedWorld>;

struct WorldName {
  template <class Setup>
  static std::string GetName(int) {
    return Setup::name();
  }
};

}  // namespace ambient::test
