#include "tests/bullet_ambient/bullet/worlds/world_setups.h"

#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorldMt.h>

#include <algorithm>
#include <type_traits>
#include <utility>

#include "tests/support/solver_kinds.h"

namespace ambient::test {
namespace {

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

template <class Kind, class World>
std::unique_ptr<WorldHost> make(bool is_ambient) {
  if (is_ambient) return std::make_unique<SingleThreadedHost<Kind, World, true>>();
  return std::make_unique<SingleThreadedHost<Kind, World, false>>();
}

std::unique_ptr<WorldHost> makeMultithreaded(bool is_ambient) {
  if (is_ambient) return std::make_unique<MultithreadedHost<true>>();
  return std::make_unique<MultithreadedHost<false>>();
}

}  // namespace

// Bullet's btMultiBodyConstraintSolver reads uninitialised members where no
// btMultiBodyDynamicsWorld calls it.
const std::vector<WorldSetup>& allWorlds() {
  using Discrete = btDiscreteDynamicsWorld;
  using Soft = btSoftRigidDynamicsWorld;
  static const std::vector<WorldSetup> worlds{
      {"DiscreteWithSequentialImpulse", make<SequentialImpulse, Discrete>},
      {"DiscreteWithConjugateGradient", make<ConjugateGradient, Discrete>},
      {"DiscreteWithDantzig", make<Dantzig, Discrete>},
      {"DiscreteWithProjectedGaussSeidel", make<ProjectedGaussSeidel, Discrete>},
      {"DiscreteWithLemke", make<Lemke, Discrete>},
      {"DiscreteWithMultithreaded", make<Multithreaded, Discrete>},
      {"SoftWithSequentialImpulse", make<SequentialImpulse, Soft>},
      {"SoftWithConjugateGradient", make<ConjugateGradient, Soft>},
      {"MultiBodiesWithMultiBody", make<MultiBody, btMultiBodyDynamicsWorld>},
      {"DiscreteMtWithPool", makeMultithreaded}};
  return worlds;
}

const WorldSetup& worldNamed(const std::string& name) {
  return *std::find_if(allWorlds().begin(), allWorlds().end(),
                       [&](const WorldSetup& setup) { return setup.name == name; });
}

}  // namespace ambient::test
