#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "bullet_ambient/bullet/members/ambient_bodies.h"
#include "bullet_ambient/saved_state.h"
#include "tests/bullet_ambient/bullet/regions/region_world.h"
#include "tests/support/bodies/free_body.h"
#include "tests/support/bodies/part_bodies.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/refusal_of.h"

namespace ambient::test {
namespace {

AttachDef inAir() { return {std::make_shared<FluidBody>(meshedEllipsoid(kUnequalAxes, 1)), air()}; }

// The sentence of what a handle throws; empty: nothing.
template <class Call>
std::string refusal(const Call& call) {
  const std::string said = refusalOf<std::logic_error>(call);  // std::invalid_argument is one
  EXPECT_EQ(said.find('\n'), std::string::npos);
  return said;
}

TEST(Immersed, TellsAndChangesWhatIsKnownOfABody) {
  FluidWorld scene;
  btRigidBody& body = scene.add(tumblingBody(Vector3::Zero()));
  const Immersed plate = scene.fluid.add(body, inAir());
  EXPECT_TRUE(plate.isValid());
  EXPECT_EQ(plate.medium().density, air().density);
  EXPECT_EQ(plate.region(), RegionId::kNone);
  plate.setMedium(water());
  EXPECT_EQ(scene.of(body).medium().density, water().density);
  const double before = plate.inertia()(3, 3);
  plate.setFluidBody(std::make_shared<FluidBody>(meshedEllipsoid(2 * kUnequalAxes, 1)));
  EXPECT_GT(plate.inertia()(3, 3), before);
  scene.step(kWorldStep);
  EXPECT_GT(plate.counters().substeps, 0);
}

TEST(Immersed, IsCheckedAfterRemoval) {
  FluidWorld scene;
  btRigidBody& body = scene.add(tumblingBody(Vector3::Zero()));
  const Immersed first = scene.fluid.add(body, inAir());
  const Immersed copy = first;
  EXPECT_TRUE(first.remove());
  EXPECT_FALSE(copy.remove());
  EXPECT_FALSE(copy.isValid());
  const Immersed second = scene.fluid.add(body, inAir());  // in the same slot
  EXPECT_FALSE(first.isValid());
  EXPECT_FALSE(first.remove());
  EXPECT_TRUE(second.isValid());
  const std::string expected = ": this Immersed was removed from its Fluid";
  EXPECT_EQ(refusal([&] { first.medium(); }), "medium" + expected);
  EXPECT_EQ(refusal([&] { first.setMedium(water()); }), "setMedium" + expected);
  EXPECT_EQ(refusal([&] { first.applyImpulse({}); }), "applyImpulse" + expected);
  EXPECT_EQ(second.medium().density, air().density);
}

TEST(Immersed, IsSafeAfterItsFluidWasDestroyed) {
  auto scene = std::make_unique<FluidWorld>();
  const Immersed body = scene->fluid.add(scene->add(tumblingBody(Vector3::Zero())), inAir());
  scene.reset();
  EXPECT_FALSE(body.isValid());
  EXPECT_FALSE(body.remove());
  EXPECT_EQ(refusal([&] { body.counters(); }),
            "counters: the Fluid or the world of this Immersed was destroyed");
}

// A solver of the program keeps what its fluid was made of.
TEST(Immersed, IsSafeAfterItsFluidWasDestroyedBeforeASolver) {
  auto scene = std::make_unique<FluidWorld>();
  const Immersed body = scene->fluid.add(scene->add(tumblingBody(Vector3::Zero())), inAir());
  const auto solver = makeSolver<btSequentialImpulseConstraintSolver>(scene->fluid);
  scene.reset();
  EXPECT_FALSE(body.isValid());
  EXPECT_EQ(refusal([&] { body.region(); }),
            "region: the Fluid or the world of this Immersed was destroyed");
}

TEST(Immersed, StaysValidWhenAStateIsRestored) {
  FluidWorld scene;
  btRigidBody& body = scene.add(tumblingBody(Vector3::Zero()));
  btRigidBody& other = scene.add(tumblingBody({3, 0, 0}));
  const Immersed stays = scene.fluid.add(body, inAir());
  const WorldState state = scene.fluid.save();
  const Immersed leaves = scene.fluid.add(other, inAir());
  stays.setMedium(water());
  scene.step(kWorldStep);
  scene.fluid.restore(state);
  EXPECT_TRUE(stays.isValid());
  EXPECT_EQ(stays.medium().density, air().density);
  EXPECT_FALSE(leaves.isValid());
  EXPECT_FALSE(scene.fluid.find(other));
}

TEST(Immersed, RefusesNothing) {
  FluidWorld scene;
  btRigidBody* nothing = nullptr;
  EXPECT_THROW(scene.fluid.add(nothing, inAir()), std::invalid_argument);
}

TEST(Naming, NamesBodiesInReportsAndErrors) {
  FluidWorld scene;
  scene.world.setGravity({0, 0, bt(-9.81)});
  std::vector<std::string> said;
  scene.fluid.setReport([&](const std::string& text) { said.push_back(text); });
  scene.fluid.setNaming([](const btCollisionObject& object) {
    return object.getUserIndex() == 7 ? std::string("crate") : std::string();
  });
  btRigidBody& crate = scene.add(tumblingBody(Vector3::Zero()));
  btRigidBody& other = scene.add(tumblingBody({3, 0, 0}));
  crate.setUserIndex(7);
  crate.setMassProps(bt(1e-6), toBullet(Vector3(Vector3::Constant(1e-6))));
  const Immersed in_air = scene.fluid.add(crate, inAir());
  ASSERT_EQ(said.size(), 1u);  // it is light
  EXPECT_EQ(said[0].rfind("bullet_ambient: body 'crate' has a mass of 1e-06 kg", 0), 0u) << said[0];
  EXPECT_EQ(refusal([&] { scene.fluid.add(crate, inAir()); }).rfind("add: body 'crate' was", 0),
            0u);
  scene.fluid.restore(scene.fluid.save());  // no state has names
  EXPECT_EQ(membersOf(scene.fluid).find(&crate)->def->name, "crate");
  AttachDef def = inAir();
  def.flight.tolerance = -1;
  EXPECT_EQ(refusal([&] { scene.fluid.add(other, def); }).rfind("add: body with fluid body '", 0),
            0u);
  def.name = "own";
  EXPECT_EQ(refusal([&] { scene.fluid.add(other, def); }).rfind("add: body 'own' has", 0), 0u);
}

// Before the first step.
TEST(RegionsOnAttach, AreFound) {
  FluidWorld scene;
  scene.world.setGravity({0, 0, bt(-9.81)});
  const RegionId sea = scene.fluid.addRegion(waterBelow(0));
  const RegionId wind = scene.fluid.addRegion(windZone({{-9, -9, 50}, {9, 9, 60}}, {8, 0, 0}));
  AttachDef def = inAir();
  def.fluid_body = std::make_shared<FluidBody>(floatingEllipsoid(kUnequalAxes, 1));
  const auto at = [&](double height) {
    return scene.fluid.add(scene.add(tumblingBody({0, 0, height})), def);
  };
  const Immersed deep = at(-20), high = at(20), windy = at(55), afloat = at(0);
  EXPECT_EQ(deep.region(), sea);
  EXPECT_EQ(deep.medium().density, water().density);
  EXPECT_GT(deep.inertia()(3, 3), 2 * high.inertia()(3, 3));
  EXPECT_EQ(high.region(), sea);  // the air above it
  EXPECT_EQ(high.medium().density, air().density);
  EXPECT_EQ(windy.region(), wind);
  EXPECT_EQ(windy.medium().velocity.x(), 8);
  EXPECT_EQ(afloat.region(), sea);
  scene.step(kWorldStep);
  EXPECT_EQ(deep.counters().medium_changes, 1);  // when it was added
}

// An impulse changes the momentum of the body and its fluid by itself.
TEST(ImmersedImpulse, ChangesTheMomentumOfABodyByItself) {
  Arbitrary arbitrary(5);
  FluidWorld scene;
  btRigidBody& body = scene.add({}, shapeWithoutFaces(arbitrary.positiveDefinite()), idealFluid(1));
  const Wrench impulse{{0.3, -0.2, 0.1}, {1, 2, 3}};
  scene.of(body).applyImpulse(impulse);
  const Vector6 momentum = scene.of(body).inertia() * readState(body).twist.vector();
  EXPECT_LT((momentum - impulse.vector()).norm(), byPrecision(1e-12, 1e-5));  // axes of W
}

}  // namespace
}  // namespace ambient::test
