#include "tests/bullet_ambient/bullet/worlds/world_setups.h"

#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorldMt.h>

#include <algorithm>
#include <type_traits>
#include <utility>

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
      ambient_.emplace(membersOf(*fluid_).shared_from_this());
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

/// Islands of more than a few contacts go to the multithreaded solver, as large ones do by default.
class MultithreadedHost final : public WorldHost {
  using Limit = btSequentialImpulseConstraintSolverMt;

 public:
  explicit MultithreadedHost(bool is_ambient)
      : default_limit_(std::exchange(Limit::s_minimumContactManifoldsForBatching, 3)) {
    if (is_ambient) fluid_.emplace(world_);
  }
  ~MultithreadedHost() override {
    fluid_.reset();
    Limit::s_minimumContactManifoldsForBatching = default_limit_;
  }
  btDiscreteDynamicsWorld& world() override { return world_; }

 private:
  int default_limit_;
  btConstraintSolverPoolMt pool_{2};
  btSequentialImpulseConstraintSolverMt large_;
  btDiscreteDynamicsWorldMt world_{&dispatcher, &broadphase, &pool_, &large_, &configuration};
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
