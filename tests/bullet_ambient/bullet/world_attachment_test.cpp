#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "bullet_ambient/ambient.h"
#include "bullet_ambient/attach_world.h"
#include "tests/support/bodies/ellipsoid_body.h"
#include "tests/support/bodies/part_bodies.h"
#include "tests/support/world.h"

namespace ambient::test {
namespace {

// Source of fluid bodies for balls of 4.19 m^3; refuses other shapes.
class BallTable : public FluidBodySource {
 public:
  std::shared_ptr<const FluidBody> fluidBody(const btCollisionShape& shape) override {
    ++asked;
    if (std::exchange(throws_once, false)) throw 1;
    if (shape.getShapeType() != SPHERE_SHAPE_PROXYTYPE) throw std::runtime_error("not a ball");
    return ball;
  }

  std::shared_ptr<const FluidBody> fluidBodyOf(const std::function<std::string()>& whose,
                                               const btCollisionShape& shape) override {
    asked_for.push_back(whose());
    return fluidBody(shape);
  }

  int asked = 0;
  std::vector<std::string> asked_for;
  bool throws_once = false;
  std::shared_ptr<const FluidBody> ball =
      std::make_shared<FluidBody>(meshedEllipsoid(Vector3::Ones(), 1));
};

class WorldInFluid : public testing::Test, protected WholeWorld<> {
 protected:
  WorldInFluid() {
    fluid.setReport([this](const std::string& sentence) { said.push_back(sentence); });
  }
  btRigidBody& add(double mass, btCollisionShape& shape) {
    const btVector3 inertia = btVector3(1, 1, 1) * static_cast<btScalar>(0.4 * mass);
    const auto x = static_cast<btScalar>(5 * (contents.bodies().size() + 1));
    return contents.add(mass, inertia, shape,
                        btTransform(btQuaternion::getIdentity(), btVector3(x, 0, 0)));
  }
  void step() { contents.step(1.0 / 60); }
  bool isAttached(const btRigidBody& body) const { return fluid.find(body).has_value(); }

  static constexpr double kHeavy = 9000;  // water: 4180 kg
  Fluid fluid{world};
  btSphereShape sphere{1};
  btBoxShape box{btVector3(1, 1, 1)};
  BallTable shapes;
  std::vector<std::string> said;
};

TEST_F(WorldInFluid, TakesEveryDynamicBodyAndSaysWhy) {
  btRigidBody& floor = add(0, box);
  btRigidBody& first = add(kHeavy, sphere);
  btRigidBody& crate = add(kHeavy, box);
  btRigidBody& second = add(2 * kHeavy, sphere);
  const AttachReport report = fluid.addAll(shapes, water());
  EXPECT_EQ(report.attached, 2);
  EXPECT_EQ(report.fluid_bodies, 1);
  EXPECT_TRUE(report.light.empty());
  ASSERT_EQ(report.refused.size(), 1u);
  EXPECT_EQ(report.refused[0].body, 2);
  EXPECT_EQ(report.refused[0].reason, "body 2 (Box): not a ball");
  EXPECT_EQ(report.text(),
            "2 bodies attached with 1 fluid bodies, 1 refused, 0 lighter than what they displace\n"
            "body 2 (Box): not a ball\n");
  EXPECT_TRUE(isAttached(first) && isAttached(second));
  EXPECT_FALSE(isAttached(floor) || isAttached(crate));
  first.setLinearVelocity({1, 0, 0});
  step();
  EXPECT_GE(fluid.find(first)->counters().substeps, 1);  // solver and action are in the world
}

TEST_F(WorldInFluid, TellsTheSourceWhichOfHowManyBodiesItIs) {
  add(0, box);
  btRigidBody& first = add(kHeavy, sphere);
  btRigidBody& second = add(kHeavy, sphere);
  fluid.setNaming([&](const btCollisionObject& object) {
    return std::string(&object == &second ? "crane" : "");
  });
  fluid.addAll(shapes, water());
  EXPECT_EQ(shapes.asked_for,
            (std::vector<std::string>{"body 1 (SPHERE), 1 of 2", "body 'crane', 2 of 2"}));
  EXPECT_TRUE(isAttached(first));
}

TEST_F(WorldInFluid, LeavesWhatIsAttachedAndWhatTheFilterDoesNotWant) {
  btRigidBody& own = add(kHeavy, sphere);
  btRigidBody& left = add(kHeavy, sphere);
  btRigidBody& right = add(kHeavy, sphere);
  fluid.add(own, {shapes.ball, air()});
  AttachSettings settings;
  settings.filter = [&](const btRigidBody& body) { return &body != &right; };
  const AttachReport report = fluid.addAll(shapes, water(), settings);
  EXPECT_EQ(report.attached, 1);
  EXPECT_EQ(report.attached_before, 1);
  EXPECT_TRUE(isAttached(left));
  EXPECT_FALSE(isAttached(right));
  EXPECT_EQ(fluid.find(own)->medium().density, air().density);
  fluid.addAll(shapes, air());  // the rest
  EXPECT_EQ(fluid.find(left)->medium().density, water().density);
  EXPECT_EQ(fluid.find(right)->medium().density, air().density);
}

TEST_F(WorldInFluid, GivesEachBodyWhatAFunctionSays) {
  btRigidBody& first = add(kHeavy, sphere);
  btRigidBody& second = add(kHeavy, sphere);
  btRigidBody& third = add(kHeavy, sphere);
  AttachSettings settings;
  settings.flow.skin_friction = false;
  settings.adjust = [&](const btRigidBody& body, AttachDef& def) {
    EXPECT_FALSE(def.flow.skin_friction);
    if (&body == &second) def.medium = air();
    if (&body == &third) def.fluid_body = nullptr;
  };
  EXPECT_EQ(fluid.addAll(shapes, water(), settings).attached, 2);
  EXPECT_EQ(fluid.find(first)->medium().density, water().density);
  EXPECT_EQ(fluid.find(second)->medium().density, air().density);
  EXPECT_FALSE(isAttached(third));
}

TEST_F(WorldInFluid, NamesWhatIsNoMassAndGoesOn) {
  add(kHeavy, sphere);
  add(kHeavy, sphere).setMassProps(btScalar(1e-300), btVector3(0, 0, 0));
  add(kHeavy, sphere);
  AttachSettings settings;
  settings.adjust = [&](const btRigidBody& body, AttachDef& def) {
    if (&body == contents.bodies()[0].get()) def.flight.max_substeps = -1;
  };
  const AttachReport report = fluid.addAll(shapes, water(), settings);
  ASSERT_GE(report.refused.size(), 1u);
  EXPECT_NE(report.refused[0].reason.find("body 0 (SPHERE): add: body with fluid body "
                                          "'ellipsoid' has max_substeps of -1"),
            std::string::npos)
      << report.refused[0].reason;
  EXPECT_TRUE(isAttached(*contents.bodies()[2]));
}

// Four cubic metres afloat may be light, but not lighter than air.
TEST_F(WorldInFluid, SaysWhichBodiesAfloatAreLighterThanAir) {
  world.setGravity({0, 0, btScalar(-9.81)});
  fluid.addRegion(waterBelow(0));
  shapes.ball = std::make_shared<FluidBody>(floatingBall(1));
  add(20, sphere);
  fluid.addAll(shapes, Medium{});
  EXPECT_TRUE(said.empty());
  add(1, sphere);
  EXPECT_EQ(fluid.addAll(shapes, Medium{}).light.size(), 1u);
  ASSERT_EQ(said.size(), 1u);
  EXPECT_NE(said[0].find("has a mass of 1 kg and displaces 5.0"), std::string::npos) << said[0];
}

TEST_F(WorldInFluid, SaysOnceWhichBodiesAreLight) {
  add(3000, sphere);  // floats like wood
  add(2000, sphere);
  add(10, sphere);
  add(1000, sphere);
  const AttachReport report = fluid.addAll(shapes, water());
  ASSERT_EQ(report.light.size(), 4u);
  EXPECT_EQ(report.light[2].body, 2);
  EXPECT_NEAR(report.light[2].mass, 10, 1e-5);
  EXPECT_NEAR(report.light[2].displaced_mass, ellipsoidVolume(Vector3::Ones()) * 998, 1e-3);
  ASSERT_EQ(said.size(), 1u);
  EXPECT_EQ(said[0],
            "bullet_ambient: body with fluid body 'ellipsoid' has a mass of 10 kg and displaces "
            "4.18e+03 kg of its medium, so that it rises, and so do 2 more of less than half that "
            "mass; if they are no balls, floats or balloons, give them the mass of their volume");
  fluid.add(add(1, sphere), {shapes.ball, water()});
  EXPECT_EQ(said.size(), 1u);
}

TEST_F(WorldInFluid, WithoutACollisionShapeABodyIsDryAndSaidToBe) {
  static btCompoundShape nothing;
  add(kHeavy, nothing);
  const AttachReport report = fluid.addAll(shapes, water());
  EXPECT_EQ(shapes.asked, 0);
  ASSERT_EQ(report.refused.size(), 1u);
  EXPECT_NE(report.refused[0].reason.find("it has no collision shape, so that no fluid acts on it"),
            std::string::npos)
      << report.refused[0].reason;
}

TEST_F(WorldInFluid, WithoutGravityNothingRises) {
  world.setGravity({0, 0, 0});
  fluid.add(add(1, sphere), {shapes.ball, water()});
  fluid.addAll(shapes, water());
  EXPECT_TRUE(said.empty());
}

TEST_F(WorldInFluid, TakesBodiesThatComeLater) {
  AttachSettings settings;
  settings.later_bodies = true;
  add(kHeavy, sphere);
  fluid.addAll(shapes, water(), settings);
  step();
  btRigidBody& later = add(kHeavy, sphere);
  EXPECT_FALSE(isAttached(later));
  step();
  EXPECT_TRUE(isAttached(later));
  // What was detached on purpose stays so, and nobody is asked again.
  fluid.find(later)->remove();
  const int asked = shapes.asked;
  step();
  EXPECT_FALSE(isAttached(later));
  EXPECT_EQ(shapes.asked, asked);
  add(kHeavy, box);
  step();
  step();
  ASSERT_EQ(said.size(), 1u);
  EXPECT_EQ(said[0], "bullet_ambient: body 2 (Box): not a ball");
}

TEST_F(WorldInFluid, WithoutTheFlagLaterBodiesStayDry) {
  add(kHeavy, sphere);
  fluid.addAll(shapes, water());
  btRigidBody& later = add(kHeavy, sphere);
  step();
  step();
  EXPECT_FALSE(isAttached(later));
}

// Replaces a body at its place in the array, usually at its address.
TEST_F(WorldInFluid, TellsABodyFromADestroyedOneInItsPlace) {
  AttachSettings settings;
  settings.later_bodies = true;
  add(kHeavy, sphere);
  add(kHeavy, sphere);
  fluid.addAll(shapes, water(), settings);
  for (int i = 0; i < 20; ++i) {
    contents.removeLast();
    btRigidBody& next = add(kHeavy, sphere);
    EXPECT_FALSE(isAttached(next));
    step();
    EXPECT_TRUE(isAttached(next));
  }
}

TEST_F(WorldInFluid, AReportThatThrowsLosesNoRefusal) {
  AttachSettings settings;
  settings.later_bodies = true;
  fluid.addAll(shapes, water(), settings);
  fluid.setReport([this](const std::string& sentence) {
    said.push_back(sentence);
    throw std::runtime_error("no terminal");
  });
  add(kHeavy, box);
  add(kHeavy, box);
  step();
  EXPECT_EQ(said.size(), 2u);
}

TEST_F(WorldInFluid, ASourceThatThrowsSomethingUnknownRefusesOneBody) {
  add(kHeavy, sphere);
  const btRigidBody& last = add(kHeavy, sphere);
  shapes.throws_once = true;
  const AttachReport report = fluid.addAll(shapes, water());
  EXPECT_TRUE(isAttached(last));
  ASSERT_EQ(report.refused.size(), 1u);
  EXPECT_EQ(report.refused[0].reason, "body 0 (SPHERE): something unknown was thrown");
}

TEST_F(WorldInFluid, NamesTheFunctionThatThrew) {
  add(kHeavy, sphere);
  AttachSettings settings;
  settings.adjust = [](const btRigidBody&, AttachDef&) { throw std::runtime_error("no table"); };
  const AttachReport adjusted = fluid.addAll(shapes, water(), settings);
  ASSERT_EQ(adjusted.refused.size(), 1u);
  EXPECT_EQ(adjusted.refused[0].reason, "body 0 (SPHERE): adjust threw: no table");
  settings.filter = [](const btRigidBody&) -> bool { throw 1; };
  const AttachReport filtered = fluid.addAll(shapes, water(), settings);
  ASSERT_EQ(filtered.refused.size(), 1u);
  EXPECT_EQ(filtered.refused[0].reason, "body 0 (SPHERE): filter threw something unknown");
}

TEST_F(WorldInFluid, ClearFollowsNothing) {
  AttachSettings settings;
  settings.later_bodies = true;
  add(kHeavy, sphere);
  fluid.addAll(shapes, water(), settings);
  fluid.clear();
  btRigidBody& later = add(kHeavy, sphere);
  step();
  EXPECT_FALSE(isAttached(later));
  EXPECT_EQ(fluid.size(), 0u);
}

}  // namespace
}  // namespace ambient::test
