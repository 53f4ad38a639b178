#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "bullet_ambient/bullet/members/ambient_bodies.h"
#include "bullet_ambient/reading.h"
#include "bullet_ambient/saved_state.h"
#include "tests/bullet_ambient/bullet/fluid_world.h"
#include "tests/bullet_ambient/bullet/regions/region_world.h"
#include "tests/support/bodies/free_body.h"
#include "tests/support/bodies/part_bodies.h"
#include "tests/support/refusal_of.h"

namespace ambient::test {
namespace {

const double kNaN = std::numeric_limits<double>::quiet_NaN();

// Returns the sentence of attach()'s refusal; empty if accepted.
std::string refusal(const BodyDef& body_def, const AttachDef& def) {
  FluidWorld scene;
  btRigidBody& body = scene.add(body_def);
  const std::string said = refusalOf<std::invalid_argument>([&] { scene.fluid.add(body, def); });
  if (!said.empty()) {
    EXPECT_EQ(scene.fluid.size(), 0u);
  }
  EXPECT_EQ(said.find('\n'), std::string::npos);
  return said;
}

void expectSays(const std::string& sentence, const char* words) {
  EXPECT_NE(sentence.find(words), std::string::npos) << "said: " << sentence;
}

/// Changes the fluid body of an attachment.
template <class Change>
void changeShape(AttachDef& def, const Change& change) {
  auto shape = std::make_shared<FluidBody>(*def.fluid_body);
  change(*shape);
  def.fluid_body = shape;
}

// Bodies of 1 kg, and balls of 1 m in air. The limit of masses is a ratio: a limit of size or
// density would depend on units.
TEST(Attach, SaysWhatIsWrong) {
  struct Wrong {
    void (*make)(BodyDef&, AttachDef&);
    const char* words;
  };
  const Wrong wrongs[] = {
      {[](BodyDef&, AttachDef& a) { a.fluid_body = nullptr; }, "fluid body is null"},
      {[](BodyDef& b, AttachDef&) { b.mass = 0; }, "mass 0"},
      {[](BodyDef& b, AttachDef&) { b.moments.setZero(); }, "angular factor"},
      {[](BodyDef&, AttachDef& a) { a.flight.tolerance = 0; }, "tolerance"},
      {[](BodyDef&, AttachDef& a) { a.flight.tolerance = kNaN; }, "tolerance"},
      {[](BodyDef&, AttachDef& a) { a.flight.max_substeps = -1; }, "max_substeps of -1"},
      {[](BodyDef&, AttachDef& a) { a.flow.law = static_cast<PressureLaw>(-1); },
       "has the pressure law number -1; there are 0 to 1"},
      {[](BodyDef&, AttachDef& a) { a.flow.precision = static_cast<LoadPrecision>(2); },
       "has the load precision number 2; there are 0 to 1"},
      {[](BodyDef&, AttachDef& a) { a.flow.separation_angle = 1; }, "between pi/2 and pi"},
      {[](BodyDef&, AttachDef& a) { a.medium.density = 1e20; }, "at most 2^52 times its own"},
      {[](BodyDef&, AttachDef& a) {
         a.fluid_body = std::make_shared<FluidBody>(facelessEllipsoid(Vector3::Constant(1e30)));
       },
       "at most 2^52 times its own"},
      {[](BodyDef&, AttachDef& a) {
         changeShape(a, [](FluidBody& shape) { shape.faces.normal_y.own().pop_back(); });
       },
       "the same in all columns"},
      {[](BodyDef&, AttachDef& a) {
         changeShape(a, [](FluidBody& shape) { shape.faces.area[3] = kNaN; });
       },
       "an entry of its faces is nan"},
      {[](BodyDef&, AttachDef& a) { a.medium.density = -1; },
       "density of the medium [kg/m^3] is -1"},
      {[](BodyDef&, AttachDef& a) { a.medium.density = kNaN; }, "density"},
      {[](BodyDef&, AttachDef& a) { a.medium.viscosity = -2; }, "viscosity"},
      {[](BodyDef&, AttachDef& a) { a.medium.viscosity = 1e25; }, "must be from 0 to 1e24"},
      {[](BodyDef&, AttachDef& a) { a.flow.roughness = -1e-4; },
       "roughness [m] is -0.0001, must be from 0 to 3.41554, the root of its area"},
      {[](BodyDef&, AttachDef& a) { a.flow.roughness = 4; }, "roughness [m] is 4"},
      {[](BodyDef&, AttachDef& a) { a.medium.velocity.setConstant(kNaN); }, "must be finite"},
      {[](BodyDef&, AttachDef& a) { a.medium.acceleration.z() = kNaN; }, "must be finite"}};
  for (const Wrong& wrong : wrongs) {
    BodyDef body;
    AttachDef attach = unitBallIn(air());
    wrong.make(body, attach);
    expectSays(refusal(body, attach), wrong.words);
  }
  EXPECT_EQ(refusal({}, unitBallIn(air())), "");
  BodyDef heavy;
  heavy.mass = 1e20;
  heavy.moments.setConstant(1e20);
  EXPECT_EQ(refusal(heavy, unitBallIn(idealFluid(1e20))), "");
}

// Attaches two equal bodies; returns the reports.
std::vector<std::string> saidAbout(const BodyDef& body_def, const AttachDef& def) {
  FluidWorld scene;
  for (int i = 0; i < 2; ++i) scene.fluid.add(scene.add(body_def), def);
  return scene.said;
}

TEST(Attach, ReportsMomentsOfInertiaOfNoRigidBodyOnce) {
  AttachDef def = unitBallIn(air());
  BodyDef sheet;
  sheet.mass = 4000;  // heavier than half of the displaced water
  sheet.moments = {1, 2, 3};
  EXPECT_TRUE(saidAbout(sheet, def).empty());
  BodyDef odd = sheet;
  odd.moments = {1, 10, 1};
  const std::vector<std::string> said = saidAbout(odd, def);
  ASSERT_EQ(said.size(), 1u);
  expectSays(said[0], "inertia of 10.0");
  expectSays(said[0], "above 2.0");
}

TEST(Attach, ReportsAnAngleThatTheFormLawDoesNotReadOnce) {
  AttachDef def = unitBallIn(air());
  EXPECT_TRUE(saidAbout({}, def).empty());
  def.flow.separation_angle = 2;
  const std::vector<std::string> said = saidAbout({}, def);
  ASSERT_EQ(said.size(), 1u);
  expectSays(said[0], "a separation angle, which the form law does not read");
  def.flow.law = PressureLaw::kPublished;
  EXPECT_TRUE(saidAbout({}, def).empty());
}

// A fluid body without resistance comes from a file of an earlier version, by readFluidBody().
TEST(Attach, ReportsAFluidBodyWithoutResistanceOnce) {
  AttachDef def{std::make_shared<FluidBody>(meshedEllipsoid({0.5, 0.4, 0.3}, 2)), air()};
  EXPECT_TRUE(saidAbout({}, def).empty());
  changeShape(def, [](FluidBody& b) { b.viscous = {}; });
  const std::vector<std::string> said = saidAbout({}, def);
  ASSERT_EQ(said.size(), 1u);
  expectSays(said[0], "moves as without viscosity: its fluid body has no resistance");
  def.medium.viscosity = 0;
  EXPECT_TRUE(saidAbout({}, def).empty());
}

TEST(Attach, ReportsAnEmptyFluidBodyOnce) {
  AttachDef def;
  auto empty = std::make_shared<FluidBody>();
  empty->name = "hollow";
  def.fluid_body = empty;
  EXPECT_TRUE(saidAbout({}, def).empty());  // vacuum: no added mass expected
  def.medium = air();
  const std::vector<std::string> said = saidAbout({}, def);
  ASSERT_EQ(said.size(), 1u);
  expectSays(said[0], "'hollow' feels no fluid");
  empty->volume = 1;
  EXPECT_TRUE(saidAbout({}, def).empty());
}

TEST(SetMedium, KeepsTheOldMediumWhenTheNewOneIsRefused) {
  FluidWorld scene;
  btRigidBody& body = scene.add({}, meshedEllipsoid(Vector3::Ones(), 1), air());
  EXPECT_THROW(scene.of(body).setMedium({-1, 0, Vector3::Zero(), Vector3::Zero()}),
               std::invalid_argument);
  EXPECT_EQ(scene.of(body).medium().density, air().density);
}

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
            "counters: the Fluid of this Immersed was destroyed");
}

// A solver of the program keeps what its fluid was made of.
TEST(Immersed, IsSafeAfterItsFluidWasDestroyedBeforeASolver) {
  auto scene = std::make_unique<FluidWorld>();
  const Immersed body = scene->fluid.add(scene->add(tumblingBody(Vector3::Zero())), inAir());
  const auto solver = makeSolver<btSequentialImpulseConstraintSolver>(scene->fluid);
  scene.reset();
  EXPECT_FALSE(body.isValid());
  EXPECT_EQ(refusal([&] { body.region(); }), "region: the Fluid of this Immersed was destroyed");
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

TEST(Naming, NamesBodiesInReportsAndErrors) {
  FluidWorld scene;
  scene.world.setGravity({0, 0, bt(-9.81)});
  scene.fluid.setNaming([](const btCollisionObject& object) {
    return object.getUserIndex() == 7 ? std::string("crate") : std::string();
  });
  btRigidBody& crate = scene.add(tumblingBody(Vector3::Zero()));
  btRigidBody& other = scene.add(tumblingBody({3, 0, 0}));
  crate.setUserIndex(7);
  crate.setMassProps(bt(1e-6), toBullet(Vector3(Vector3::Constant(1e-6))));
  const Immersed in_air = scene.fluid.add(crate, inAir());
  ASSERT_EQ(scene.said.size(), 1u);  // it is light
  EXPECT_EQ(scene.said[0].rfind("bullet_ambient: body 'crate' has a mass of 1e-06 kg", 0), 0u)
      << scene.said[0];
  EXPECT_EQ(refusal([&] { scene.fluid.add(crate, inAir()); }).rfind("add: body 'crate' was", 0),
            0u);
  scene.fluid.restore(scene.fluid.save());  // no state has names
  EXPECT_EQ(ambientBodiesOf(scene.fluid).find(&crate)->def->name, "crate");
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

// Factors on the added mass and on the loads of a body.

const Vector3 kMoments(0.02, 0.03, 0.04);

btRigidBody& addEllipsoid(FluidWorld& world, double density) {
  return world.add({2, kMoments}, facelessEllipsoid(kUnequalAxes), idealFluid(density));
}

TEST(Factors, ScaleTheAddedMassAtRest) {
  for (const double factor : {0.3, 1.0, 1.7}) {
    FluidWorld world;
    btRigidBody& body = addEllipsoid(world, 40);
    const Matrix6 dry = rigidBodyInertia(2, kMoments.asDiagonal());
    const Matrix6 added = world.of(body).inertia() - dry;
    world.of(body).setFactors(factor, 1);
    EXPECT_LT((world.of(body).inertia() - dry - factor * added).norm(),
              byPrecision(1e-13, 1e-6) * added.norm());
    body.applyCentralForce({0, 0, bt(3)});
    world.step(kWorldStep);
    const double expected = 3 * kWorldStep / (2 + factor * added(5, 5));
    EXPECT_NEAR(static_cast<double>(body.getLinearVelocity().z()), expected,
                byPrecision(1e-12, 1e-6) * expected);
  }
}

double terminalSpeed(double factor) {
  FluidWorld world;
  world.world.setGravity({0, 0, bt(-kGravity)});
  btRigidBody& body =
      world.add({300, Vector3::Constant(120)}, meshedEllipsoid(Vector3::Ones(), 2), idealFluid(40));
  world.of(body).setFactors(1, factor);
  world.step(kWorldStep, 4000);
  return std::abs(static_cast<double>(body.getLinearVelocity().z()));
}

// Without viscosity drag goes with the square of the speed. A step, of 0.005 times in which the
// ball slows down, is wrong by less than the square of that.
TEST(Factors, ScaleTheLoads) {
  const double speed = terminalSpeed(1);
  for (const double factor : {0.5, 2.0})
    EXPECT_NEAR(terminalSpeed(factor) * std::sqrt(factor), speed, byPrecision(1e-5, 1e-4) * speed);
}

/// A box half in water.
btRigidBody& addFloat(FluidWorld& world) {
  world.world.setGravity({0, 0, bt(-kGravity)});
  world.fluid.addRegion(seaUnderAir());
  FluidBody box = boxBody(kBoxSize);
  box.added_mass.diagonal() << 0.004, 0.006, 0.003, 0.05, 0.07, 0.15;
  return world.add({500 * kBoxSize.prod(), Vector3(4.2, 6.4, 8)}, box, air());
}

TEST(Factors, ScaleTheAddedMassAtTheSurface) {
  FluidWorld world;
  btRigidBody& body = addFloat(world);
  world.step(kWorldStep);
  const RigidState pose = readState(body);
  const auto at = [&](double factor) {
    world.of(body).setFactors(factor, 1);
    return Matrix6(world.of(body).inertia());
  };
  const Matrix6 once = at(1), half = at(0.5), twice = at(2);
  EXPECT_GT(twice(5, 5), 1.2 * once(5, 5));
  EXPECT_LT((twice - once - 2 * (once - half)).norm(), 1e-9 * once.norm());
  EXPECT_EQ(readState(body).position, pose.position);
}

TEST(Factors, AreInSavedStates) {
  FluidWorld one, other;
  btRigidBody& here = addFloat(one);
  btRigidBody& there = addFloat(other);
  one.of(here).setFactors(1.3, 0.6);
  one.step(kWorldStep, 20);
  other.fluid.restore(one.fluid.save());
  one.step(kWorldStep, 50);
  other.step(kWorldStep, 50);
  EXPECT_TRUE(moveAlike(here, there));
  other.of(there).setFactors(1, 0.6);
  one.step(kWorldStep, 5);
  other.step(kWorldStep, 5);
  EXPECT_FALSE(moveAlike(here, there));
}

TEST(Factors, MustBePositiveAndFinite) {
  FluidWorld world;
  btRigidBody& body = addEllipsoid(world, 40);
  const Matrix6 inertia = world.of(body).inertia();
  for (const double factor : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THROW(world.of(body).setFactors(factor, 1), std::invalid_argument);
    EXPECT_THROW(world.of(body).setFactors(1, factor), std::invalid_argument);
  }
  EXPECT_EQ(Matrix6(world.of(body).inertia()), inertia);
}

}  // namespace
}  // namespace ambient::test
