#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <type_traits>
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
template <class Kind>
constexpr bool kNeedsOneIslandPerGroup =
    std::is_same_v<Kind, ConjugateGradient> || std::is_same_v<typename Kind::Base, btMLCPSolver>;

/// The same scene with Bullet's own solver and with the ambient one.
template <class Setup>
struct ScenePair {
  ScenePair() {
    if (!kNeedsOneIslandPerGroup<typename Setup::Kind>) return;
    for (VacuumScene* scene : {&stock, &ambient})
      scene->host().world().getSolverInfo().m_minimumSolverBatchSize = 1;
  }
  VacuumScene stock{Setup::make(false)};
  VacuumScene ambient{Setup::make(true)};
};

template <class Setup>
class StockMotion : public ::testing::Test {};
TYPED_TEST_SUITE(StockMotion, AllWorlds, WorldName);

TYPED_TEST(StockMotion, OfAWorldWithoutAmbientBodiesIsKeptBitForBit) {
  ScenePair<TypeParam> scenes;
  expectSameBits(scenes.stock, scenes.ambient, 1000);
}

TYPED_TEST(StockMotion, OfBodiesBesideAFlyingAmbientOneIsKeptBitForBit) {
  ScenePair<TypeParam> scenes;
  AmbientRegistry& registry = scenes.ambient.host().registry;
  for (VacuumScene* scene : {&scenes.stock, &scenes.ambient}) {
    btRigidBody& body = scene->addAside({0, 0, 500});
    body.setAngularVelocity({1, 2, 3});
    if (scene == &scenes.ambient) registry.attach(body, inThinFluid());
  }
  expectSameBits(scenes.stock, scenes.ambient, 500);
  EXPECT_GT(registry.counters().load_evaluations, 0);
}

TYPED_TEST(StockMotion, OfBodiesInAFluidOfDensityZeroIsKeptBitForBit) {
  ScenePair<TypeParam> scenes;
  AttachDef def = inThinFluid();
  def.medium.density = 0;
  AmbientRegistry& registry = scenes.ambient.host().registry;
  for (btRigidBody* body : scenes.ambient.bodies()) registry.attach(*body, def);
  expectSameBits(scenes.stock, scenes.ambient, 500);
  EXPECT_EQ(registry.counters().rows, 0);
  EXPECT_EQ(registry.counters().load_evaluations, 0);
}

TYPED_TEST(StockMotion, ReturnsWhenABodyIsDetached) {
  ScenePair<TypeParam> scenes;
  AmbientRegistry& registry = scenes.ambient.host().registry;
  btRigidBody& body = *scenes.ambient.bodies()[2];
  registry.attach(body, inThinFluid());
  EXPECT_TRUE(registry.detach(body));
  EXPECT_FALSE(registry.detach(body));
  expectSameBits(scenes.stock, scenes.ambient, 500);
}

TYPED_TEST(StockMotion, OfBodiesBesideAnAmbientOneThatSlidesIsKeptBitForBit) {
  if constexpr (std::is_same_v<typename TypeParam::Kind, Lemke>)
    GTEST_SKIP() << "at speeds by chance, it throws the sliding body about, into the others";
  ScenePair<TypeParam> scenes;
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
