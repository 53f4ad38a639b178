#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "tests/bullet_ambient/bullet/worlds/vacuum_scene.h"
#include "tests/support/ellipsoid_body.h"

// What is not in a fluid moves bit for bit as in stock Bullet, whatever the world and the solver.
namespace ambient::test {
namespace {

constexpr int kStepsBetween = 50;

// Half of what floats.
AttachDef inThinFluid() {
  AttachDef def;
  def.fluid_body = std::make_shared<FluidBody>(meshedEllipsoid(Vector3(0.5, 0.4, 0.3), 1));
  def.medium.density = 2;
  return def;
}

void expectSameBits(VacuumScene& stock, VacuumScene& ambient, int steps) {
  for (int step = 0; step < steps; step += kStepsBetween) {
    stock.step(kStepsBetween);
    ambient.step(kStepsBetween);
    const auto a = stock.state(), b = ambient.state();
    const auto differing = std::mismatch(a.begin(), a.end(), b.begin()).first - a.begin();
    ASSERT_TRUE(sameBits(a, b)) << "number " << differing << " of " << a.size() << " after step "
                                << step + kStepsBetween;
  }
  EXPECT_GT(stock.ballTravel(), 1);  // things do happen
}

// Conjugate gradients and complementarity solvers work on all rows of a group at once: the islands
// that Bullet merges into one group act on each other, by rounding at least.
bool needsOneIslandPerGroup(const WorldSetup& setup) {
  const auto is_used = [&](const char* solver) { return usesSolver(setup, solver); };
  return is_used("ConjugateGradient") || is_used("Dantzig") || is_used("ProjectedGaussSeidel") ||
         is_used("Lemke");
}

/// The same scene with Bullet's own solver and with the ambient one.
struct ScenePair {
  explicit ScenePair(const WorldSetup& setup)
      : stock(setup.make(false)), ambient(setup.make(true)) {
    if (!needsOneIslandPerGroup(setup)) return;
    for (VacuumScene* scene : {&stock, &ambient})
      scene->host().world().getSolverInfo().m_minimumSolverBatchSize = 1;
  }
  /// Lemke's solver inverts the matrix of all rows. That of a box on a floor is singular unless
  /// they are soft: four contacts have more rows than the box has ways to move, and rounding throws
  /// the box about, into the others.
  void softenIfSingular(const WorldSetup& setup) {
    if (!usesSolver(setup, "Lemke")) return;
    for (VacuumScene* scene : {&stock, &ambient})
      scene->host().world().getSolverInfo().m_globalCfm = static_cast<btScalar>(1e-3);
  }
  VacuumScene stock, ambient;
};

class StockMotion : public testing::TestWithParam<WorldSetup> {};
INSTANTIATE_TEST_SUITE_P(Of, StockMotion, testing::ValuesIn(allWorlds()), nameOf);

TEST_P(StockMotion, OfAWorldWithoutAmbientBodiesIsKeptBitForBit) {
  ScenePair scenes(GetParam());
  expectSameBits(scenes.stock, scenes.ambient, 1000);
}

TEST_P(StockMotion, OfBodiesBesideAFlyingAmbientOneIsKeptBitForBit) {
  ScenePair scenes(GetParam());
  AmbientRegistry& registry = scenes.ambient.host().registry;
  for (VacuumScene* scene : {&scenes.stock, &scenes.ambient}) {
    btRigidBody& body = scene->addAside({0, 0, 500});
    body.setAngularVelocity({1, 2, 3});
    if (scene == &scenes.ambient) registry.attach(body, inThinFluid());
  }
  expectSameBits(scenes.stock, scenes.ambient, 500);
  EXPECT_GT(registry.counters().load_evaluations, 0);
}

TEST_P(StockMotion, OfBodiesInAFluidOfDensityZeroIsKeptBitForBit) {
  ScenePair scenes(GetParam());
  AttachDef def = inThinFluid();
  def.medium.density = 0;
  AmbientRegistry& registry = scenes.ambient.host().registry;
  for (btRigidBody* body : scenes.ambient.bodies()) registry.attach(*body, def);
  expectSameBits(scenes.stock, scenes.ambient, 500);
  EXPECT_EQ(registry.counters().rows, 0);
  EXPECT_EQ(registry.counters().load_evaluations, 0);
}

TEST_P(StockMotion, ReturnsWhenABodyIsDetached) {
  ScenePair scenes(GetParam());
  AmbientRegistry& registry = scenes.ambient.host().registry;
  btRigidBody& body = *scenes.ambient.bodies()[2];
  registry.attach(body, inThinFluid());
  EXPECT_TRUE(registry.detach(body));
  EXPECT_FALSE(registry.detach(body));
  expectSameBits(scenes.stock, scenes.ambient, 500);
}

TEST_P(StockMotion, OfBodiesBesideAnAmbientOneThatSlidesIsKeptBitForBit) {
  ScenePair scenes(GetParam());
  scenes.softenIfSingular(GetParam());
  AmbientRegistry& registry = scenes.ambient.host().registry;
  for (VacuumScene* scene : {&scenes.stock, &scenes.ambient}) {
    btRigidBody& body = scene->addAside({30, 30, static_cast<btScalar>(0.5)});
    body.setActivationState(DISABLE_DEACTIVATION);
    body.setLinearVelocity({2, 1, 0});
    body.setAngularVelocity({0, 0, 3});
    if (scene == &scenes.ambient) registry.attach(body, inThinFluid());
  }
  expectSameBits(scenes.stock, scenes.ambient, 1000);
  EXPECT_GT(registry.counters().rows, 500);
}

}  // namespace
}  // namespace ambient::test
