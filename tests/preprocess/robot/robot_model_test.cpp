#include "preprocess/robot/robot_model.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/preprocess/robot/urdf_text_of.h"
#include "tests/support/refusal_of.h"

namespace ambient {
namespace {

std::string complaintOf(const std::string& content, bool fixed_base = false) {
  return test::refusalOf([&] { checkRobot(parseRobot(content), fixed_base); });
}

TEST(RobotModel, FixedLinksBecomePartOfTheirParent) {
  // Two links of 2 kg; the second one is 1 m above the first, with a quarter turn about z.
  const RobotModel robot = withoutFixedJoints(parseRobot(
      massiveLink("a") +
      massiveLink("b", "<collision><geometry><sphere radius=\"1\"/></geometry></collision>") +
      massiveLink("c") +
      joint("ab", "fixed", "a", "b", R"(<origin xyz="0 0 1" rpy="0 0 1.5707963267948966"/>)") +
      joint("bc", "continuous", "b", "c", R"(<origin xyz="1 0 0"/>)")));
  ASSERT_EQ(robot.links.size(), 2u);
  const LinkModel& a = robot.links[0];
  EXPECT_EQ(a.mass, 4);
  EXPECT_LT((a.centre_of_mass - Vector3(0, 0, 0.5)).norm(), 1e-15);
  // Steiner: 2 kg (0.5 m)^2 each; a quarter turn exchanges x and y of the second link.
  EXPECT_NEAR(a.inertia(0, 0), 0.1 + 0.2 + 2 * 2 * 0.25, 1e-14);
  EXPECT_NEAR(a.inertia(1, 1), 0.2 + 0.1 + 2 * 2 * 0.25, 1e-14);
  EXPECT_NEAR(a.inertia(2, 2), 0.5, 1e-14);
  ASSERT_EQ(a.collisions.size(), 1u);
  EXPECT_EQ(a.collisions[0].pose.translation().z(), 1);
  EXPECT_EQ(robot.linkIndex("b"), 0);
  EXPECT_EQ(robot.linkIndex("c"), 1);
  EXPECT_EQ(robot.jointIndex("bc"), 1);
  EXPECT_EQ(robot.links[1].parent, 0);
  EXPECT_LT((robot.links[1].joint.origin.translation() - Eigen::Vector3d(0, 1, 1)).norm(), 1e-15);
}

TEST(RobotModel, LinksWithAFluidOfTheirOwnStay) {
  const RobotModel robot = withoutFixedJoints(
      parseRobot(massiveLink("a") + massiveLink("b", "<ambient/>") + massiveLink("c") +
                 joint("ab", "fixed", "a", "b") + joint("bc", "fixed", "b", "c")));
  ASSERT_EQ(robot.links.size(), 2u);
  EXPECT_EQ(robot.links[1].mass, 4);
}

TEST(RobotModel, AnEmptyRootLetsItsChildFloat) {
  const std::string content = "<link name=\"world\"/>" + massiveLink("a") +
                              joint("free", "floating", "world", "a", R"(<origin xyz="1 2 3"/>)");
  EXPECT_NE(complaintOf(content), "");
  const RobotModel robot = withoutFixedJoints(parseRobot(content));
  ASSERT_EQ(robot.links.size(), 1u);
  checkRobot(robot, false);
  EXPECT_EQ(linkPoses(robot, RigidPose::Identity())[0].translation(), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(robot.linkIndex("world"), 0);
}

TEST(RobotModel, PosesOfTwoArms) {
  // Two bars of 1 m in a plane: the second one ends at (cos a + cos(a + b), ...).
  const RobotModel robot = parseRobot(
      massiveLink("a") + massiveLink("b") + massiveLink("c") + massiveLink("d") +
      joint("ab", "continuous", "a", "b", R"(<axis xyz="0 0 1"/>)") +
      joint("bc", "continuous", "b", "c", R"(<origin xyz="1 0 0"/><axis xyz="0 0 1"/>)") +
      joint("cd", "prismatic", "c", "d",
            R"(<axis xyz="1 0 0"/><limit lower="0" upper="2" effort="1" velocity="1"/>)"));
  const auto poses =
      linkPoses(robot, RigidPose::Identity(), {{"ab", 0.3}, {"bc", 0.4}, {"cd", 1.0}});
  EXPECT_NEAR(poses[3].translation().x(), std::cos(0.3) + std::cos(0.7), 1e-15);
  EXPECT_NEAR(poses[3].translation().y(), std::sin(0.3) + std::sin(0.7), 1e-15);
}

TEST(RobotModel, RefusesWhatCannotMove) {
  const std::string light = R"(<link name="b"/>)";
  EXPECT_EQ(complaintOf(massiveLink("a") + light + joint("j", "continuous", "a", "b")),
            "r.urdf: link \"b\": its mass is 0 kg; must be > 0 where a link moves");
  EXPECT_EQ(complaintOf(light),
            "r.urdf: link \"b\": its mass is 0 kg; must be > 0 where a link moves; a fixed base "
            "(fixed_base) needs none");
  EXPECT_EQ(complaintOf(light, true), "");
  EXPECT_EQ(complaintOf(R"(<link name="b"><inertial><mass value="1"/>
      <inertia ixx="0" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>)"),
            "r.urdf: link \"b\": its smallest moment of inertia is 0 kg m^2; must be > 0 where a "
            "link moves");
  EXPECT_EQ(complaintOf(massiveLink("a") + massiveLink("b") +
                        joint("j", "continuous", "a", "b", R"(<mimic joint="k"/>)")),
            "r.urdf: joint \"k\" is not known; known are: j");
  EXPECT_NE(complaintOf(massiveLink("a") + massiveLink("b") +
                        joint("j", "continuous", "a", "b", R"(<mimic joint="j"/>)"))
                .find("and not the same"),
            std::string::npos);
  EXPECT_NE(complaintOf(massiveLink("a") + massiveLink("b") + joint("j", "floating", "a", "b"))
                .find("joint \"j\": it is floating"),
            std::string::npos);
  EXPECT_THROW(parseRobot(massiveLink("a")).linkIndex("b"), std::runtime_error);
}

}  // namespace
}  // namespace ambient
