#include <gtest/gtest.h>

#include <cmath>

#include "tests/preprocess/robot/robot_world.h"
#include "tests/preprocess/robot/urdf_text_of.h"

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
  RobotWorld in;
  Robot robot(wheelOnBase(R"(<dynamics friction="0.5"/>)"), fixedBase());
  robot.addTo(in.world);
  robot.multiBody().setJointVel(0, 4);
  in.step(robot, 0.01, 100);
  EXPECT_NEAR(robot.velocity("ab"), 4 - 0.5 * 1 / kWheelMoment, 100 * rounding());
  in.step(robot, 0.01, 150);
  EXPECT_NEAR(robot.velocity("ab"), 0, rounding());
}

TEST(RobotJoints, DampingDecaysAndNeverTurnsRound) {
  RobotWorld in;
  Robot robot(wheelOnBase(R"(<dynamics damping="0.5"/>)"), fixedBase());
  robot.addTo(in.world);
  robot.multiBody().setJointVel(0, 4);
  in.step(robot, 0.001, 1000);
  // First-order steps: (1 - h d / I)^n.
  EXPECT_NEAR(robot.velocity("ab"), 4 * std::pow(1 - 0.001 * 0.5 / kWheelMoment, 1000),
              1000 * rounding());
  in.step(robot, 10, 1);
  EXPECT_NEAR(robot.velocity("ab"), 0, rounding());
}

TEST(RobotJoints, EffortIsLimitedByTheJointAndTheTarget) {
  RobotWorld in;
  Robot robot(wheelOnBase(R"(<limit effort="2" velocity="3"/>)"), fixedBase());
  robot.addTo(in.world);
  MotorTarget target;
  target.velocity = 100;
  target.position_gain = 0;
  robot.setMotor("ab", target);
  in.step(robot, 0.01, 10);
  EXPECT_NEAR(robot.velocity("ab"), 0.1 * 2 / kWheelMoment, 10 * rounding());
  target.effort = 0.5;
  robot.setMotor("ab", target);
  in.step(robot, 0.01, 10);
  EXPECT_NEAR(robot.velocity("ab"), 0.1 * 2.5 / kWheelMoment, 10 * rounding());
  target.effort = JointModel::kUnlimited;
  robot.setMotor("ab", target);
  in.step(robot, 0.01, 100);
  EXPECT_NEAR(robot.velocity("ab"), 3, 10 * rounding());
}

TEST(RobotJoints, TellWhatAMotorUsed) {
  RobotWorld in;
  Robot robot(wheelOnBase(R"(<limit effort="2" velocity="3"/>)"), fixedBase());
  robot.addTo(in.world);
  EXPECT_EQ(robot.motorEffort("ab"), 0);
  MotorTarget target;
  target.velocity = 1;
  target.position_gain = 0;
  robot.setMotor("ab", target);
  in.step(robot, 0.01, 1);
  EXPECT_NEAR(robot.motorEffort("ab"), 2, 10 * rounding());
  in.step(robot, 0.01, 100);
  EXPECT_NEAR(robot.motorEffort("ab"), 0, 1000 * rounding());  // it turns as it should
  target.velocity = -1;
  target.effort = 0.5;
  robot.setMotor("ab", target);
  in.step(robot, 0.01, 1);
  EXPECT_NEAR(robot.motorEffort("ab"), -0.5, 10 * rounding());
  target.effort = 0;
  robot.setMotor("ab", target);
  in.step(robot, 0.01, 1);
  EXPECT_EQ(robot.motorEffort("ab"), 0);
}

TEST(RobotJoints, PositionMotorFollowsASine) {
  RobotWorld in;
  Robot robot(wheelOnBase(""), fixedBase());
  robot.addTo(in.world);
  const double h = 1e-3;
  double largest = 0;
  for (int i = 0; i < 2000; ++i) {
    const double t = i * h;
    MotorTarget target;
    target.position = std::sin(3 * t);
    target.velocity = 3 * std::cos(3 * (t + h));
    robot.setMotor("ab", target);
    in.step(robot, h);
    if (i > 100)
      largest = std::max(largest, std::abs(robot.position("ab") - std::sin(3 * (t + h))));
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
    RobotWorld in;
    Robot robot(model, fixedBase());
    robot.addTo(in.world);
    robot.multiBody().setJointVel(0, static_cast<btScalar>(way));
    // Bullet acts on a limit after it is passed; corrects a fifth per step.
    double furthest = 0;
    for (int i = 0; i < 1000; ++i) {
      in.step(robot, 0.001);
      furthest = std::max(furthest, way * robot.position("ab"));
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
  RobotWorld in;
  RobotSettings settings = fixedBase();
  settings.positions = {{"ac", 0.3}};
  Robot robot(model, settings);
  robot.addTo(in.world);
  MotorTarget target;
  target.velocity = 1;
  target.position_gain = 0;
  robot.setMotor("ab", target);
  in.step(robot, 0.001, 500);
  EXPECT_NEAR(robot.position("ab"), 0.5, 2e-3);
  EXPECT_NEAR(robot.position("ac"), -2 * robot.position("ab") + 0.3, 2e-3);
}

// Each step changes the velocity by the gain times the difference to the target.
TEST(RobotJoints, VelocityGainIsTheShareOfAStep) {
  for (const double gain : {0.1, 0.25, 1.0}) {
    RobotWorld in;
    Robot robot(wheelOnBase(""), fixedBase());
    robot.addTo(in.world);
    robot.multiBody().setJointVel(0, 1);
    MotorTarget target;
    target.velocity = 5;
    target.position_gain = 0;
    target.velocity_gain = gain;
    robot.setMotor("ab", target);
    for (int n = 1; n <= 8; ++n) {
      in.step(robot, 0.01);
      EXPECT_NEAR(robot.velocity("ab"), 5 - 4 * std::pow(1 - gain, n), 100 * rounding())
          << gain << ", step " << n;
    }
  }
}

}  // namespace
}  // namespace ambient
