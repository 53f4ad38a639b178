#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "tests/bullet_ambient/bullet/worlds/vacuum_scene.h"
#include "tests/support/bodies/ellipsoid_body.h"

// Dry bodies must move bit for bit like stock Bullet, in any world and with any solver.
namespace ambient::test {
namespace {

constexpr int kStepsBetween = 50;

// Fluid body with half of the density at which the body floats.
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
  EXPECT_GT(stock.ballTravel(), 1);  // the ball moves
}

// Tells if the setup needs one group per island. Conjugate gradients and complementarity solvers
// couple all rows of a group, so islands merged into a group act on each other.
bool needsOneIslandPerGroup(const WorldSetup& setup) {
  const auto is_used = [&](const char* solver) { return usesSolver(setup, solver); };
  return is_used("ConjugateGradient") || is_used("Dantzig") || is_used("ProjectedGaussSeidel") ||
         is_used("Lemke");
}

/// Equal scenes with Bullet's solver and with the ambient one.
struct ScenePair {
  explicit ScenePair(const WorldSetup& setup)
      : stock(setup.make(false)), ambient(setup.make(true)) {
    if (!needsOneIslandPerGroup(setup)) return;
    for (VacuumScene* scene : {&stock, &ambient})
      scene->host().world().getSolverInfo().m_minimumSolverBatchSize = 1;
  }
  /// Adds softness for Lemke's solver, which inverts the matrix of all rows. A box on a floor has
  /// dependent rows: four contacts have more rows than degrees of freedom. Without softness
  /// rounding throws the box into other bodies.
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
  Fluid& fluid = scenes.ambient.host().fluid();
  for (VacuumScene* scene : {&scenes.stock, &scenes.ambient}) {
    btRigidBody& body = scene->addAside({0, 0, 500});
    body.setAngularVelocity({1, 2, 3});
    if (scene == &scenes.ambient) fluid.add(body, inThinFluid());
  }
  expectSameBits(scenes.stock, scenes.ambient, 500);
  EXPECT_GT(fluid.counters().load_evaluations, 0);
}

TEST_P(StockMotion, OfBodiesInAFluidOfDensityZeroIsKeptBitForBit) {
  ScenePair scenes(GetParam());
  AttachDef def = inThinFluid();
  def.medium.density = 0;
  Fluid& fluid = scenes.ambient.host().fluid();
  for (btRigidBody* body : scenes.ambient.bodies()) fluid.add(*body, def);
  expectSameBits(scenes.stock, scenes.ambient, 500);
  EXPECT_EQ(fluid.counters().rows, 0);
  EXPECT_EQ(fluid.counters().load_evaluations, 0);
}

TEST_P(StockMotion, ReturnsWhenABodyIsDetached) {
  ScenePair scenes(GetParam());
  Fluid& fluid = scenes.ambient.host().fluid();
  btRigidBody& body = *scenes.ambient.bodies()[2];
  fluid.add(body, inThinFluid());
  EXPECT_TRUE(fluid.find(body)->remove());
  EXPECT_FALSE(fluid.find(body));
  expectSameBits(scenes.stock, scenes.ambient, 500);
}

TEST_P(StockMotion, OfBodiesBesideAnAmbientOneThatSlidesIsKeptBitForBit) {
  ScenePair scenes(GetParam());
  scenes.softenIfSingular(GetParam());
  Fluid& fluid = scenes.ambient.host().fluid();
  for (VacuumScene* scene : {&scenes.stock, &scenes.ambient}) {
    btRigidBody& body = scene->addAside({30, 30, static_cast<btScalar>(0.5)});
    body.setActivationState(DISABLE_DEACTIVATION);
    body.setLinearVelocity({2, 1, 0});
    body.setAngularVelocity({0, 0, 3});
    if (scene == &scenes.ambient) fluid.add(body, inThinFluid());
  }
  expectSameBits(scenes.stock, scenes.ambient, 1000);
  EXPECT_GT(fluid.counters().rows, 500);
}

}  // namespace
}  // namespace ambient::test
