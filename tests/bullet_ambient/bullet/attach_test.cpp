#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "tests/bullet_ambient/bullet/fluid_world.h"
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
         changeShape(a, [](FluidBody& shape) { shape.faces.normal_y.pop_back(); });
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
       "roughness [m] is -0.0001, must be from 0 to 3.54491, the root of its area"},
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
  std::vector<std::string> said;
  scene.fluid.setReport([&](const std::string& text) { said.push_back(text); });
  for (int i = 0; i < 2; ++i) scene.fluid.add(scene.add(body_def), def);
  return said;
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

TEST(Attach, RefusesTheSameBodyTwice) {
  FluidWorld scene;
  btRigidBody& body = scene.add({}, meshedEllipsoid(Vector3::Ones(), 1), air());
  expectSays(refusalOf<std::invalid_argument>([&] { scene.fluid.add(body, unitBallIn(air())); }),
             "added already");
  EXPECT_EQ(scene.fluid.size(), 1u);
}

TEST(SetMedium, KeepsTheOldMediumWhenTheNewOneIsRefused) {
  FluidWorld scene;
  btRigidBody& body = scene.add({}, meshedEllipsoid(Vector3::Ones(), 1), air());
  EXPECT_THROW(scene.of(body).setMedium({-1, 0, Vector3::Zero(), Vector3::Zero()}),
               std::invalid_argument);
  EXPECT_EQ(scene.of(body).medium().density, air().density);
}

TEST(Fluid, TotalInertiaIsThatOfBodyAndFluid) {
  FluidWorld scene;
  BodyDef def;
  def.mass = 2;
  def.moments = Vector3(0.3, 0.4, 0.5);
  const FluidBody shape = facelessEllipsoid(Vector3(1, 2, 3));
  const btRigidBody& body = scene.add(def, shape, water());
  Vector6 expected = water().density * shape.added_mass.diagonal();
  expected += (Vector6() << 0.3, 0.4, 0.5, 2, 2, 2).finished();
  const Vector6 diagonal = scene.of(body).inertia().diagonal();
  EXPECT_LT((diagonal - expected).norm(), 1e-6 * expected.norm());
}

}  // namespace
}  // namespace ambient::test
