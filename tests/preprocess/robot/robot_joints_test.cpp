#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>

#include "bullet_ambient/ambient.h"
#include "bullet_ambient/bullet/core/conversions.h"
#include "preprocess/collision_shape/fluid_body_cache.h"
#include "preprocess/robot/robot.h"
#include "tests/preprocess/robot/fluid_robot_world.h"
#include "tests/preprocess/robot/urdf_text_of.h"
#include "tests/support/refusal_of.h"

namespace ambient {
namespace {

/// A wheel of 0.25 kg m^2 about z on a fixed base.
RobotModel wheelOnBase(const std::string& more) {
  return parseRobot("<link name=\"a\"/>" + massiveLink("b") +
                    joint("ab", "continuous", "a", "b", R"(<axis xyz="0 0 1"/>)" + more));
}

constexpr double kWheelMoment = 0.25;

RobotSettings fixedBase() {
  RobotSettings settings;
  settings.fixed_base = true;
  return settings;
}

TEST(RobotJoints, FrictionStopsAWheel) {
  RobotWorld in(wheelOnBase(R"(<dynamics friction="0.5"/>)"), fixedBase());
  in.robot.multiBody().setJointVel(0, 4);
  in.step(0.01, 100);
  EXPECT_NEAR(in.robot.velocity("ab"), 4 - 0.5 * 1 / kWheelMoment, 100 * rounding());
  in.step(0.01, 150);
  EXPECT_NEAR(in.robot.velocity("ab"), 0, rounding());
}

TEST(RobotJoints, DampingDecaysAndNeverTurnsRound) {
  RobotWorld in(wheelOnBase(R"(<dynamics damping="0.5"/>)"), fixedBase());
  in.robot.multiBody().setJointVel(0, 4);
  in.step(0.001, 1000);
  // First-order steps: (1 - h d / I)^n.
  EXPECT_NEAR(in.robot.velocity("ab"), 4 * std::pow(1 - 0.001 * 0.5 / kWheelMoment, 1000),
              1000 * rounding());
  in.step(10, 1);
  EXPECT_NEAR(in.robot.velocity("ab"), 0, rounding());
}

TEST(RobotJoints, EffortIsLimitedByTheJointAndTheTarget) {
  RobotWorld in(wheelOnBase(R"(<limit effort="2" velocity="3"/>)"), fixedBase());
  MotorTarget target = MotorTarget::speed(100);
  in.robot.setMotor("ab", target);
  in.step(0.01, 10);
  EXPECT_NEAR(in.robot.velocity("ab"), 0.1 * 2 / kWheelMoment, 10 * rounding());
  target.effort = 0.5;
  in.robot.setMotor("ab", target);
  in.step(0.01, 10);
  EXPECT_NEAR(in.robot.velocity("ab"), 0.1 * 2.5 / kWheelMoment, 10 * rounding());
  target.effort = JointModel::kUnlimited;
  in.robot.setMotor("ab", target);
  in.step(0.01, 100);
  EXPECT_NEAR(in.robot.velocity("ab"), 3, 10 * rounding());
}

TEST(RobotJoints, TellWhatAMotorUsed) {
  RobotWorld in(wheelOnBase(R"(<limit effort="2" velocity="3"/>)"), fixedBase());
  EXPECT_EQ(in.robot.motorEffort("ab"), 0);
  MotorTarget target = MotorTarget::speed(1);
  in.robot.setMotor("ab", target);
  in.step(0.01, 1);
  EXPECT_NEAR(in.robot.motorEffort("ab"), 2, 10 * rounding());
  in.step(0.01, 100);
  EXPECT_NEAR(in.robot.motorEffort("ab"), 0, 1000 * rounding());  // it turns as it should
  target.velocity = -1;
  target.effort = 0.5;
  in.robot.setMotor("ab", target);
  in.step(0.01, 1);
  EXPECT_NEAR(in.robot.motorEffort("ab"), -0.5, 10 * rounding());
  target.effort = 0;
  in.robot.setMotor("ab", target);
  in.step(0.01, 1);
  EXPECT_EQ(in.robot.motorEffort("ab"), 0);
}

TEST(RobotJoints, PositionMotorFollowsASine) {
  RobotWorld in(wheelOnBase(""), fixedBase());
  const double h = 1e-3;
  double largest = 0;
  for (int i = 0; i < 2000; ++i) {
    const double t = i * h;
    MotorTarget target;
    target.position = std::sin(3 * t);
    target.velocity = 3 * std::cos(3 * (t + h));
    in.robot.setMotor("ab", target);
    in.step(h);
    if (i > 100)
      largest = std::max(largest, std::abs(in.robot.position("ab") - std::sin(3 * (t + h))));
  }
  // Euler's error per step, h^2 9 / 2, over the part corrected per step, the gain of 0.1.
  EXPECT_LT(largest, 1.05 * h * h * 9 / 2 / 0.1);
  EXPECT_GT(largest, 0.5 * h * h * 9 / 2 / 0.1);
}

TEST(RobotJoints, LimitHoldsAPendulum) {
  const RobotModel model = parseRobot(
      "<link name=\"a\"/>" + massiveLink("b") +
      joint("ab", "revolute", "a", "b",
            R"(<axis xyz="0 0 1"/><limit lower="-0.2" upper="0.3" effort="1" velocity="9"/>)"));
  for (const double way : {-1.0, 1.0}) {
    RobotWorld in(model, fixedBase());
    in.robot.multiBody().setJointVel(0, static_cast<btScalar>(way));
    // Bullet acts on a limit after it is passed; corrects a fifth per step.
    double furthest = 0;
    for (int i = 0; i < 1000; ++i) {
      in.step(0.001);
      furthest = std::max(furthest, way * in.robot.position("ab"));
    }
    EXPECT_NEAR(furthest, way < 0 ? 0.2 : 0.3, 1.001e-3);
  }
}

TEST(RobotJoints, MimicFollows) {
  const RobotModel model =
      parseRobot("<link name=\"a\"/>" + massiveLink("b") + massiveLink("c") +
                 joint("ab", "continuous", "a", "b", R"(<axis xyz="0 0 1"/>)") +
                 joint("ac", "continuous", "a", "c",
                       R"(<axis xyz="0 0 1"/><mimic joint="ab" multiplier="-2" offset="0.3"/>)"));
  RobotSettings settings = fixedBase();
  settings.positions = {{"ac", 0.3}};
  RobotWorld in(model, settings);
  in.robot.setMotor("ab", MotorTarget::speed(1));
  in.step(0.001, 500);
  EXPECT_NEAR(in.robot.position("ab"), 0.5, 2e-3);
  EXPECT_NEAR(in.robot.position("ac"), -2 * in.robot.position("ab") + 0.3, 2e-3);
}

// Each step changes the velocity by the gain times the difference to the target.
TEST(RobotJoints, VelocityGainIsTheShareOfAStep) {
  for (const double gain : {0.1, 0.25, 1.0}) {
    RobotWorld in(wheelOnBase(""), fixedBase());
    in.robot.multiBody().setJointVel(0, 1);
    MotorTarget target = MotorTarget::speed(5);
    target.velocity_gain = gain;
    in.robot.setMotor("ab", target);
    for (int n = 1; n <= 8; ++n) {
      in.step(0.01);
      EXPECT_NEAR(in.robot.velocity("ab"), 5 - 4 * std::pow(1 - gain, n), 100 * rounding())
          << gain << ", step " << n;
    }
  }
}

// Hulls on links without mass, which fixed joints hold to links that have one.

std::string hull(const std::string& name, const std::string& size, const std::string& more = "") {
  return "<link name=\"" + name + "\">" + more + R"(<collision><origin xyz="0.1 0 0.2"/>
      <geometry><box size=")" +
         size + R"("/></geometry></collision></link>)";
}

const char* const kJointPose = R"(<origin xyz="0.05 0.1 -0.3" rpy="0.2 0.3 -0.4"/>)";

/// A root with the mass and a hull without; the other way round; both on the child of such a root.
const std::string kLoadedRoot = massiveLink("load") + hull("hull", "0.2 0.1 0.1") +
                                joint("fixed", "fixed", "load", "hull", kJointPose);
const std::string kHullRoot = hull("hull", "0.2 0.1 0.1") + massiveLink("load") +
                              joint("fixed", "fixed", "hull", "load", kJointPose);
const std::string kSiblings = "<link name=\"root\"/>" + hull("hull", "0.2 0.1 0.1") +
                              hull("keel", "0.1 0.1 0.05") + massiveLink("load") +
                              joint("a", "fixed", "root", "hull", kJointPose) +
                              joint("b", "fixed", "root", "load", R"(<origin rpy="0 0.5 0"/>)") +
                              joint("c", "fixed", "load", "keel", kJointPose);

/// Ways into a fluid.
void attachLinks(FluidRobotWorld& in, Robot& robot, FluidBodyCache& shapes) {
  attachRobot(in.fluid, robot, shapes, {});
}
void attachWorld(FluidRobotWorld& in, Robot&, FluidBodyCache& shapes) {
  const AttachReport report = in.fluid.addAll(shapes, Medium{});
  EXPECT_EQ(report.attached, 1) << report.text();
  EXPECT_TRUE(report.refused.empty()) << report.text();
}

/// Pose of the link "load" after 1 s in water. Box and mass are about neutral.
template <class Attach>
RigidPose poseAfloat(RobotModel model, const Attach& attach) {
  FluidRobotWorld in;
  in.world.setGravity({0, 0, btScalar(-9.81)});
  FluidRegion everywhere;
  everywhere.below = water();
  in.fluid.addRegion(everywhere);
  Robot robot(std::move(model));
  robot.addTo(in.world);
  CollisionShapeSettings coarse;
  coarse.flow.max_panels = 300;
  FluidBodyCache shapes(coarse);
  attach(in, robot, shapes);
  for (int i = 0; i < 400; ++i) in.world.stepSimulation(btScalar(0.0025), 0);
  in.fluid.clear();
  return robot.linkPose("load");
}

TEST(CarriedHull, FloatsTheLinkThatHasTheMass) {
  for (const std::string& text : {kLoadedRoot, kHullRoot, kSiblings}) {
    const RobotModel model = parseRobot(text);
    // The flow around two parts is solved on panels whose places depend on the frame: the poses are
    // 2.2e-3 apart with 300 panels, 1.3e-3 with 3000.
    const double bound = text == kSiblings ? 5e-3 : 1e-3;
    const RigidPose merged = poseAfloat(withoutFixedJoints(model), attachLinks);
    EXPECT_GT(merged.translation().z(), -1);  // in a vacuum: -4.9
    EXPECT_GT((merged.matrix() - RigidPose::Identity().matrix()).norm(), 0.1);
    for (const auto& attach : {attachLinks, attachWorld}) {
      const RigidPose pose = poseAfloat(model, attach);
      EXPECT_LT((pose.matrix() - merged.matrix()).norm(), bound) << text;
    }
  }
}

/// The same links in a btMultiBody of the program, whose colliders stay with their links.
struct OwnMultiBody {
  OwnMultiBody(FluidRobotWorld& in, bool is_anchored)
      : body(in.contents.take(std::make_unique<btMultiBody>(
            2, btScalar(2), btVector3(btScalar(0.1), btScalar(0.2), btScalar(0.25)), false,
            false))) {
    const btQuaternion turn({0, 1, 0}, btScalar(0.7));
    const btVector3 to_pivot(btScalar(0.1), 0, 0), to_centre(0, 0, btScalar(-0.3)), axis(0, 1, 0);
    const btVector3 moments(1, 1, 1);
    if (is_anchored) {
      body.setupFixed(0, 0, {0, 0, 0}, -1, turn, to_pivot, to_centre);
    } else {
      body.setupRevolute(0, 0, {0, 0, 0}, -1, turn, axis, to_pivot, to_centre);
    }
    body.setupRevolute(1, 1, moments, 0, turn, axis, to_pivot, to_centre);
    body.finalizeMultiDof();
    for (int link = -1; link < 2; ++link)
      in.contents.addCollider(body, link, link == 0 ? static_cast<btCollisionShape&>(box) : none);
  }

  btBoxShape box{{btScalar(0.5), btScalar(0.2), btScalar(0.1)}};
  btCompoundShape none;
  btMultiBody& body;
};

TEST(CarriedHull, IsWhereItsLinkIs) {
  FluidRobotWorld in;
  OwnMultiBody own(in, true);
  FluidBodyCache shapes;
  const AttachReport report = in.fluid.addAll(shapes, water());
  EXPECT_EQ(report.attached, 1) << report.text();
  ASSERT_TRUE(in.fluid.find(own.body, -1));
  const WetState wet = in.fluid.find(own.body, -1)->wet();
  EXPECT_NEAR(wet.volume, 0.08, 1e-7);
  const btVector3 centre = own.body.localPosToWorld(0, {0, 0, 0});
  EXPECT_LT((wet.centre_of_buoyancy - toVector3(centre)).norm(), 1e-6);

  in.fluid.clear();
  const Immersed added = in.fluid.add(own.body, 0, {shapes.fluidBody(own.box), water()});
  EXPECT_LT((added.wet().centre_of_buoyancy - toVector3(centre)).norm(), 1e-6);
  for (const int link : {-1, 0}) {
    const AttachDef again{shapes.fluidBody(own.box), water()};
    const std::string said =
        test::refusalOf<std::invalid_argument>([&] { in.fluid.add(own.body, link, again); });
    EXPECT_NE(said.find("added already"), std::string::npos) << said;
  }
}

TEST(CarriedHull, IsRefusedWhereNothingCarriesIt) {
  FluidRobotWorld in;
  OwnMultiBody own(in, false);
  in.fluid.setNaming([](const btCollisionObject& object) {
    return "link " + std::to_string(btMultiBodyLinkCollider::upcast(&object)->m_link);
  });
  FluidBodyCache shapes;
  const AttachReport report = in.fluid.addAll(shapes, water());
  EXPECT_NE(report.text().find("'link 0': it has no mass, and no fixed joint holds it"),
            std::string::npos)
      << report.text();
  EXPECT_THROW(in.fluid.add(own.body, 0, {shapes.fluidBody(own.box), water()}),
               std::invalid_argument);
}

}  // namespace
}  // namespace ambient
