#include "preprocess/robot/rigid_robot.h"

#include <gtest/gtest.h>

#include "tests/preprocess/robot/robot_world.h"
#include "tests/preprocess/robot/urdf_text_of.h"

namespace ambient {
namespace {

const char* const kPlace = R"(<origin xyz="0.4 0.1 -0.3" rpy="-0.4 0.2 0.9"/>)";
const char* const kAxis = R"(<axis xyz="1 -2 3"/>)";
const char* const kLimit = R"(<limit lower="-0.5" upper="0.4" effort="1000" velocity="3"/>)";

RobotModel armModel() {
  return parseRobot(massiveLink("a") + massiveLink("b") + massiveLink("c") + massiveLink("d") +
                    joint("ab", "revolute", "a", "b", std::string(kPlace) + kAxis + kLimit) +
                    joint("bc", "prismatic", "b", "c", std::string(kPlace) + kAxis + kLimit) +
                    joint("cd", "fixed", "c", "d", kPlace));
}

RobotSettings bentArm() {
  RobotSettings settings;
  settings.fixed_base = true;
  settings.pose.translation() = Vector3(1, 2, 3);
  settings.positions = {{"ab", 0.2}, {"bc", -0.3}};
  return settings;
}

TEST(RigidRobot, BodiesAreWhereTheModelHasThem) {
  const RobotModel model = armModel();
  const RigidRobot robot(model, bentArm());
  const auto expected = linkPoses(model, bentArm().pose, bentArm().positions);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const std::string& name = model.links[i].name;
    const RigidPose pose = toPose(robot.body(name).getWorldTransform()) * robot.linkInBody(name);
    EXPECT_LT((pose.matrix() - expected[i].matrix()).norm(), 10 * rounding()) << name;
  }
  EXPECT_NEAR(robot.position("ab"), 0.2, 10 * rounding());
  EXPECT_NEAR(robot.position("bc"), -0.3, 10 * rounding());
}

TEST(RigidRobot, MotorsDriveJointsToTheirLimits) {
  for (const std::string name : {"ab", "bc"})
    for (const double way : {-1.0, 1.0}) {
      RobotWorld in;
      RigidRobot robot(armModel(), bentArm());
      robot.addTo(in.world);
      const double begin = robot.position(name);
      robot.setVelocity(name, way, 1000, 0.001);
      for (int i = 0; i < 100; ++i) in.world.stepSimulation(btScalar(0.001), 0);
      EXPECT_NEAR(robot.position(name), begin + 0.1 * way, 0.01) << name << way;
      for (int i = 0; i < 1900; ++i) in.world.stepSimulation(btScalar(0.001), 0);
      EXPECT_NEAR(robot.position(name), way < 0 ? -0.5 : 0.4, 0.03) << name << way;
    }
}

TEST(RigidRobot, LeavesItsWorld) {
  RobotWorld in;
  {
    RigidRobot robot(armModel());
    robot.addTo(in.world);
    EXPECT_EQ(in.world.getNumCollisionObjects(), 4);
    EXPECT_EQ(in.world.getNumConstraints(), 3);
  }
  EXPECT_EQ(in.world.getNumCollisionObjects(), 0);
  EXPECT_EQ(in.world.getNumConstraints(), 0);
}

TEST(RigidRobot, RefusesWhatRigidBodiesCannotBe) {
  const std::string two = massiveLink("a") + massiveLink("b");
  EXPECT_THROW(RigidRobot(parseRobot(two + joint("j", "planar", "a", "b"))), std::runtime_error);
  EXPECT_THROW(RigidRobot(parseRobot(massiveLink("a") + "<link name=\"b\"/>" +
                                     joint("j", "fixed", "a", "b"))),
               std::runtime_error);
  RobotSettings settings;
  settings.positions = {{"no", 0}};
  EXPECT_THROW(RigidRobot(armModel(), settings), std::runtime_error);
  EXPECT_THROW(RigidRobot(armModel()).position("cd"), std::runtime_error);
  EXPECT_THROW(RigidRobot(armModel()).body("e"), std::runtime_error);
}

TEST(RigidRobot, AtRestItSleepsIfItCan) {
  for (const bool can_sleep : {false, true}) {
    RobotSettings settings;
    settings.can_sleep = can_sleep;
    RobotWorld in;
    RigidRobot robot(armModel(), settings);
    robot.addTo(in.world);
    for (int i = 0; i < 30; ++i) in.world.stepSimulation(btScalar(0.1), 0);
    EXPECT_EQ(robot.body("a").isActive(), !can_sleep);
    EXPECT_EQ(robot.body("c").isActive(), !can_sleep);
  }
}

}  // namespace
}  // namespace ambient
