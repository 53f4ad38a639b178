#include "tests/bullet_ambient/bullet/worlds/world_setups.h"

#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorldMt.h>

#include <algorithm>
#include <optional>
#include <type_traits>

#include "tests/support/solver_kinds.h"

namespace ambient::test {
namespace {

/// A solver that takes the place of the plain one that the fluid of a world was made with.
template <class Kind, class World, bool kIsAmbient>
class SingleThreadedHost final : public WorldHost {
  static constexpr bool kHasMultiBodies = std::is_base_of_v<btMultiBodyDynamicsWorld, World>;
  using Plain = std::conditional_t<kHasMultiBodies, btMultiBodyConstraintSolver,
                                   btSequentialImpulseConstraintSolver>;

 public:
  SingleThreadedHost() {
    if constexpr (kIsAmbient) {
      fluid_.emplace(world_);
      ambient_.emplace(ambientBodiesOf(*fluid_).shared_from_this());
      set(ambient_->solver);
    } else {
      set(stock_.solver);
    }
  }
  ~SingleThreadedHost() override { fluid_.reset(); }
  btDiscreteDynamicsWorld& world() override { return world_; }

 private:
  template <class Solver>
  void set(Solver& solver) {
    if constexpr (kHasMultiBodies) {
      world_.setMultiBodyConstraintSolver(&solver);
    } else {
      world_.setConstraintSolver(&solver);
    }
  }

  Plain plain_;
  typename Kind::Stock stock_;
  World world_{&dispatcher, &broadphase, &plain_, &configuration};
  std::optional<typename Kind::Ambient> ambient_;
};

/// A world with a pool of the fluid's solvers.
class MultithreadedHost final : public WorldHost {
 public:
  explicit MultithreadedHost(bool is_ambient) {
    if (!is_ambient) return;
    world_.setConstraintSolver(&plain_);
    fluid_.emplace(world_);
    using Base = btSequentialImpulseConstraintSolver;
    btConstraintSolver* solvers[] = {makeSolver<Base>(*fluid_).release(),
                                     makeSolver<Base>(*fluid_).release()};
    ambient_pool_.emplace(solvers, 2);
    world_.setConstraintSolver(&*ambient_pool_);
  }
  ~MultithreadedHost() override { fluid_.reset(); }
  btDiscreteDynamicsWorld& world() override { return world_; }

 private:
  btSequentialImpulseConstraintSolver plain_;
  btConstraintSolverPoolMt pool_{2};
  std::optional<btConstraintSolverPoolMt> ambient_pool_;
  btDiscreteDynamicsWorldMt world_{&dispatcher, &broadphase, &pool_, nullptr, &configuration};
};

template <class Kind, class World>
std::unique_ptr<WorldHost> make(bool is_ambient) {
  if (is_ambient) return std::make_unique<SingleThreadedHost<Kind, World, true>>();
  return std::make_unique<SingleThreadedHost<Kind, World, false>>();
}

std::unique_ptr<WorldHost> makeMultithreaded(bool is_ambient) {
  return std::make_unique<MultithreadedHost>(is_ambient);
}

}  // namespace

// Leaves out btMultiBodyConstraintSolver except in a btMultiBodyDynamicsWorld: elsewhere the solver
// reads uninitialised members.
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
