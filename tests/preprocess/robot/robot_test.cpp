#include "preprocess/robot/robot.h"

#include <gtest/gtest.h>

#include "preprocess/collision_shape/fluid_body_cache.h"
#include "tests/preprocess/robot/fluid_robot_world.h"
#include "tests/preprocess/robot/urdf_text_of.h"
#include "tests/reference/ellipsoid_added_mass.h"
#include "tests/support/refusal_of.h"

namespace ambient {
namespace {

/// A link of 3 kg with a full tensor about a centre of mass off its origin.
std::string skewLink(const std::string& name) {
  return "<link name=\"" + name + R"("><inertial><origin xyz="0.3 -0.2 0.1" rpy="0.3 0.5 -0.7"/>
      <mass value="3"/><inertia ixx="0.5" iyy="0.6" izz="0.7" ixy="0.05" ixz="-0.1" iyz="0.07"/>
      </inertial><collision><geometry><sphere radius="0.1"/></geometry></collision></link>)";
}

const char* const kSkewOrigin = R"(<origin xyz="0.4 0.1 -0.3" rpy="-0.4 0.2 0.9"/>)";
const char* const kSkewAxis = R"(<axis xyz="1 -2 3"/>)";
const char* const kWideLimit = R"(<limit lower="-9" upper="9" effort="1e6" velocity="1e6"/>)";

RobotModel skewRobot() {
  const std::string how = std::string(kSkewOrigin) + kSkewAxis + kWideLimit;
  return parseRobot(
      skewLink("a") + skewLink("b") + skewLink("c") + skewLink("d") + skewLink("e") +
      joint("ab", "revolute", "a", "b", how) + joint("bc", "prismatic", "b", "c", how) +
      joint("cd", "fixed", "c", "d", kSkewOrigin) + joint("de", "planar", "d", "e", how));
}

RigidPose skewPose() {
  RigidPose pose = RigidPose::Identity();
  pose.linear() = Quaternion(0.9, 0.1, -0.3, 0.2).normalized().toRotationMatrix();
  pose.translation() = Vector3(1, 2, 3);
  return pose;
}

TEST(Robot, LinksAreWhereTheModelHasThem) {
  RobotSettings settings;
  settings.pose = skewPose();
  settings.positions = {{"ab", 0.7}, {"bc", -0.4}};
  const RobotModel model = skewRobot();
  const std::vector<RigidPose> expected = linkPoses(model, settings.pose, settings.positions);
  for (const bool merged : {false, true}) {
    const Robot robot(merged ? withoutFixedJoints(model) : model, settings);
    EXPECT_EQ(robot.multiBody().getNumLinks(), merged ? 3 : 4);
    for (std::size_t i = 0; i < expected.size(); ++i) {
      const RigidPose pose = robot.linkPose(model.links[i].name);
      EXPECT_LT((pose.matrix() - expected[i].matrix()).norm(), 10 * rounding()) << i;
    }
  }
}

TEST(Robot, MayBeginInMotion) {
  RobotSettings settings;
  settings.pose = skewPose();
  settings.twist_W = {Vector3(1, 2, 3), Vector3(-1, 0, 4)};
  settings.velocities = {{"ab", 0.7}, {"bc", -0.4}};
  RobotWorld in(skewRobot(), settings);
  EXPECT_NEAR(in.robot.velocity("ab"), 0.7, rounding());
  EXPECT_NEAR(in.robot.velocity("bc"), -0.4, rounding());
  const btMultiBody& body = in.robot.multiBody();
  EXPECT_LT((body.getBaseVel() - btVector3(-1, 0, 4)).length(), rounding());
  EXPECT_LT((body.getBaseOmega() - btVector3(1, 2, 3)).length(), rounding());
  const Vector3 before = in.robot.linkPose("a") * in.robot.model().links[0].centre_of_mass;
  in.robot.setTwist({});
  in.robot.setVelocity("ab", 0);
  in.robot.setVelocity("bc", 0);
  RigidPose moved = skewPose();
  moved.translation() += Vector3(5, 0, 0);
  in.robot.setPose(moved);
  in.robot.setPosition("ab", 0.3);
  in.step(1e-3);
  const Vector3 after = in.robot.linkPose("a") * in.robot.model().links[0].centre_of_mass;
  EXPECT_LT((after - before - Vector3(5, 0, 0)).norm(), 10 * rounding());
  EXPECT_NEAR(in.robot.position("ab"), 0.3, rounding());
}

TEST(Robot, WithAFixedBaseHasNoVelocity) {
  RobotSettings settings;
  settings.fixed_base = true;
  settings.twist_W.linear = {1, 0, 0};
  EXPECT_THROW(Robot(skewRobot(), settings), std::runtime_error);
}

// Bullet's own limit is 100 rad/s.
TEST(Robot, TurnsAsFastAsItIsDriven) {
  RobotSettings settings;
  settings.velocities = {{"ab", 628}};
  settings.fixed_base = true;
  RobotWorld in(parseRobot("<link name=\"a\"/>" + skewLink("b") +
                           joint("ab", "continuous", "a", "b", kSkewAxis)),
                settings);
  in.step(1e-4, 3);
  EXPECT_NEAR(in.robot.velocity("ab"), 628, 1);
}

TEST(Robot, MassPropertiesAreThoseOfTheModel) {
  const Robot robot(skewRobot(), {});
  const LinkModel& link = robot.model().links[1];
  const btMultibodyLink& made = robot.multiBody().getLink(0);
  EXPECT_EQ(made.m_mass, 3);
  const Matrix3 axes = robot.linkInBody(0).linear();
  const Vector3 moments(made.m_inertiaLocal.x(), made.m_inertiaLocal.y(), made.m_inertiaLocal.z());
  const Matrix3 inertia = axes.transpose() * moments.asDiagonal() * axes;
  EXPECT_LT((inertia - link.inertia).norm(), rounding());
  EXPECT_LT((robot.linkInBody(0) * link.centre_of_mass).norm(), rounding());
}

// First step of a compound pendulum from rest: h a.(r x m g) / a.(I + m (r^2 - r r^T)) a.
TEST(Robot, PendulumBeginsToFallAsItsFullInertiaSays) {
  const RobotModel model =
      parseRobot("<link name=\"a\"/>" + skewLink("b") +
                 joint("ab", "continuous", "a", "b", std::string(kSkewOrigin) + kSkewAxis));
  RobotSettings settings;
  settings.fixed_base = true;
  settings.pose = skewPose();
  settings.positions = {{"ab", 0.3}};
  RobotWorld in(model, settings, {0, 0, -10});
  in.step(1e-3);

  const LinkModel& link = model.links[1];
  const RigidPose pose = linkPoses(model, settings.pose, settings.positions)[1];
  const Vector3 gravity = pose.linear().transpose() * Vector3(0, 0, -10);
  const Vector3 r = link.centre_of_mass, a = link.joint.axis;
  const Matrix3 about_pivot =
      link.inertia + link.mass * (r.squaredNorm() * Matrix3::Identity() - r * r.transpose());
  const double expected = 1e-3 * a.dot(r.cross(link.mass * gravity)) / a.dot(about_pivot * a);
  EXPECT_NEAR(in.robot.velocity("ab") / expected, 1, 10 * rounding());
}

TEST(Robot, SliderFallsAlongItsAxis) {
  const RobotModel model = parseRobot(
      "<link name=\"a\"/>" + skewLink("b") +
      joint("ab", "prismatic", "a", "b", std::string(kSkewOrigin) + kSkewAxis + kWideLimit));
  RobotSettings settings;
  settings.fixed_base = true;
  RobotWorld in(model, settings, {0, 0, -10});
  in.step(1e-3);
  const Vector3 axis = model.links[1].joint.origin.linear() * model.links[1].joint.axis;
  EXPECT_NEAR(in.robot.velocity("ab"), 1e-3 * axis.dot(Vector3(0, 0, -10)), rounding());
}

// Bullet's cached transforms of links lag by one step.
TEST(Robot, PosesOfLinksAreThoseOfTheEndOfAStep) {
  const RobotModel model = skewRobot();
  RobotWorld in(model, {}, {0, 0, -10});
  in.step(0.01, 10);
  const std::map<std::string, double> positions{{"ab", in.robot.position("ab")},
                                                {"bc", in.robot.position("bc")}};
  const std::vector<RigidPose> expected = linkPoses(model, in.robot.linkPose(-1), positions);
  for (int number = 0; number < 3; ++number)
    EXPECT_LT((in.robot.linkPose(number).matrix() -
               expected[static_cast<std::size_t>(number + 1)].matrix())
                  .norm(),
              100 * rounding())
        << number;
}

TEST(Robot, FixedLinksMoveAsMergedOnes) {
  const RobotModel model = skewRobot();
  RobotSettings settings;
  settings.positions = {{"ab", 0.7}, {"bc", -0.4}};
  std::vector<RigidPose> ends;
  for (const bool merged : {false, true}) {
    RobotWorld in(merged ? withoutFixedJoints(model) : model, settings, {0, 0, -10});
    in.robot.setMotor("ab", MotorTarget::speed(2));
    in.step(1e-3, 100);
    EXPECT_NEAR(in.robot.velocity("ab"), 2, 100 * rounding());
    ends.push_back(in.robot.linkPose("e"));
  }
  EXPECT_LT((ends[0].matrix() - ends[1].matrix()).norm(), 1000 * rounding());
}

TEST(Robot, LeavesItsWorld) {
  test::TreeWorld in;
  {
    Robot robot(skewRobot(), {});
    robot.addTo(in.world);
    robot.setMotor("ab", {});
    EXPECT_EQ(in.world.getNumMultibodies(), 1);
    EXPECT_EQ(in.world.getNumCollisionObjects(), 5);
    robot.prepareStep(0.01);
    in.world.stepSimulation(btScalar(0.01), 0);
  }
  EXPECT_EQ(in.world.getNumMultibodies(), 0);
  EXPECT_EQ(in.world.getNumCollisionObjects(), 0);
  EXPECT_EQ(in.world.getNumMultiBodyConstraints(), 0);
  in.world.stepSimulation(btScalar(0.01), 0);
}

TEST(Robot, RefusesBadSettings) {
  RobotSettings settings;
  settings.positions = {{"no", 1}};
  EXPECT_THROW(Robot(skewRobot(), settings), std::runtime_error);
  settings.positions = {{"de", 1}};
  EXPECT_THROW(Robot(skewRobot(), settings), std::runtime_error);
  settings.positions = {{"ab", std::nan("")}};
  EXPECT_THROW(Robot(skewRobot(), settings), std::runtime_error);
  settings.positions.clear();
  settings.pose.translation().x() = std::nan("");
  EXPECT_THROW(Robot(skewRobot(), settings), std::runtime_error);
  Robot robot(skewRobot(), {});
  MotorTarget target;
  target.effort = -1;
  EXPECT_THROW(robot.setMotor("ab", target), std::runtime_error);
  EXPECT_THROW(robot.setMotor("cd", {}), std::runtime_error);
  const RobotModel missing = parseRobot(massiveLink(
      "a", "<collision><geometry><mesh filename=\"missing.obj\"/></geometry></collision>"));
  EXPECT_THROW(Robot(missing, {}), std::runtime_error);
}

// Two arms of one base that overlap by 0.05 m, without a joint between the arms.
RobotModel crossedArms() {
  const std::string ball = "<collision><geometry><sphere radius=\"0.1\"/></geometry></collision>";
  const std::string slides = R"(<axis xyz="1 0 0"/>)" + std::string(kWideLimit);
  return parseRobot(massiveLink("a") + massiveLink("b", ball) + massiveLink("c", ball) +
                    joint("ab", "prismatic", "a", "b", slides) +
                    joint("ac", "prismatic", "a", "c", slides));
}

TEST(Robot, LinksPushEachOtherApartWithSelfCollisionOnly) {
  for (const bool self_collision : {false, true}) {
    RobotSettings settings;
    settings.fixed_base = true;
    settings.positions = {{"ab", 1}, {"ac", 1.15}};
    settings.self_collision = self_collision;
    RobotWorld in(crossedArms(), settings);
    in.step(0.01, 100);
    const double distance = in.robot.position("ac") - in.robot.position("ab");
    if (self_collision)
      EXPECT_GT(distance, 0.195);
    else
      EXPECT_NEAR(distance, 0.15, 10 * rounding());
  }
}

// Bullet puts a multibody to sleep after two seconds of slow motion.
TEST(Robot, AtRestItSleepsIfItCan) {
  for (const bool can_sleep : {false, true}) {
    RobotSettings settings;
    settings.can_sleep = can_sleep;
    RobotWorld in(skewRobot(), settings);
    in.step(0.1, 19);
    EXPECT_TRUE(in.robot.multiBody().isAwake());
    in.step(0.1, 3);
    EXPECT_EQ(in.robot.multiBody().isAwake(), !can_sleep);
    in.robot.setMotor("ab", {});
    EXPECT_TRUE(in.robot.multiBody().isAwake());
  }
}

std::string ellipsoidLink(const std::string& name, const std::string& more = "") {
  return massiveLink(name, more + R"(<collision><origin xyz="0 0 0.5"/>
      <geometry><ellipsoid semi_axes="0.1 0.2 0.3"/></geometry></collision>)");
}

TEST(RobotFluid, LinksGetTheAddedMassOfTheirShapes) {
  const RobotModel model = parseRobot(
      ellipsoidLink("a") + ellipsoidLink("b") + ellipsoidLink("c", "<ambient medium=\"none\"/>") +
      massiveLink("d") + joint("ab", "continuous", "a", "b", R"(<axis xyz="1 0 0"/>)") +
      joint("ac", "continuous", "a", "c") + joint("ad", "continuous", "a", "d"));
  FluidRobotWorld in;
  Robot robot(model);
  robot.addTo(in.world);
  FluidBodyCache shapes;
  AttachDef def;
  def.medium = water();
  EXPECT_EQ(attachRobot(in.fluid, robot, shapes, def), (std::vector<std::string>{"a", "b"}));
  const Matrix6 K = in.fluid.find(robot.multiBody(), robot.linkNumber("b"))->inertia();
  const auto added = reference::ellipsoidAddedMass({0.1, 0.2, 0.3});
  // Principal axes of the mass are the link's, in equal order. Linear parts are independent of the
  // origin.
  for (int k = 0; k < 3; ++k)
    EXPECT_NEAR(K(3 + k, 3 + k), 2 + water().density * added[3 + k], 1e-4) << k;
  in.world.stepSimulation(btScalar(0.01), 0);
  in.fluid.clear();
}

TEST(RobotFluid, RoughnessIsThatOfTheLink) {
  const RobotModel model =
      parseRobot(ellipsoidLink("a") + ellipsoidLink("b", "<ambient roughness=\"9\"/>") +
                 joint("ab", "continuous", "a", "b"));
  FluidRobotWorld in;
  Robot robot(model);
  FluidBodyCache shapes;
  AttachDef def;
  def.medium = water();
  const std::string said = test::refusalOf([&] { attachRobot(in.fluid, robot, shapes, def); });
  EXPECT_NE(said.find("link \"b\": "), std::string::npos) << said;
  EXPECT_NE(said.find("roughness [m] is 9"), std::string::npos) << said;
}

TEST(RobotFluid, RefusalNamesTheLinkAndLeavesNothing) {
  const RobotModel model = parseRobot(
      ellipsoidLink("a") + ellipsoidLink("b", "<ambient fluid_body=\"no/such.ambient\"/>") +
      joint("ab", "continuous", "a", "b"));
  FluidRobotWorld in;
  Robot robot(model);
  robot.addTo(in.world);
  FluidBodyCache shapes;
  AttachDef def;
  def.medium = water();
  const std::string said = test::refusalOf([&] { attachRobot(in.fluid, robot, shapes, def); });
  EXPECT_EQ(said.find("r.urdf: link \"b\": no/such.ambient"), 0u) << said;
  EXPECT_FALSE(in.fluid.find(robot.multiBody(), -1));
}

}  // namespace
}  // namespace ambient
