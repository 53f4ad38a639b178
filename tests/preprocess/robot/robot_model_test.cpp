#include "preprocess/robot/robot_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <sstream>

#include "tests/preprocess/robot/urdf_text_of.h"
#include "tests/support/comma_locale.h"
#include "tests/support/refusal_of.h"
#include "tests/support/refusals.h"
#include "tests/support/temporary_folder.h"

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

std::string complaintAbout(const std::string& content) {
  return test::refusalOf([&] { parseRobot(content); });
}

TEST(UrdfReader, ReadsLinksAndJoints) {
  const RobotModel robot =
      parseRobot(massiveLink("hull") + massiveLink("arm") +
                 joint("shoulder", "revolute", "hull", "arm",
                       R"(<origin xyz="1 2 3" rpy="0 0 1.5707963267948966"/><axis xyz="0 2 0"/>
               <limit lower="-1" upper="0.5" effort="30" velocity="4"/>
               <dynamics damping="0.7" friction="0.2"/>)"));
  ASSERT_EQ(robot.links.size(), 2u);
  EXPECT_EQ(robot.name, "r");
  EXPECT_EQ(robot.links[0].name, "hull");
  EXPECT_EQ(robot.links[0].parent, -1);
  EXPECT_EQ(robot.links[0].mass, 2);
  const JointModel& shoulder = robot.links[1].joint;
  EXPECT_EQ(robot.links[1].parent, 0);
  EXPECT_EQ(shoulder.kind, UrdfJointKind::kRevolute);
  EXPECT_EQ(shoulder.axis, Vector3(0, 1, 0));
  EXPECT_EQ(shoulder.lower, -1);
  EXPECT_EQ(shoulder.upper, 0.5);
  EXPECT_EQ(shoulder.effort, 30);
  EXPECT_EQ(shoulder.velocity, 4);
  EXPECT_EQ(shoulder.damping, 0.7);
  EXPECT_EQ(shoulder.friction, 0.2);
  // A quarter turn about z maps x to y.
  EXPECT_LT((shoulder.origin * Vector3(1, 0, 0) - Vector3(1, 3, 3)).norm(), 1e-15);
}

TEST(UrdfReader, TurnsTheInertiaIntoTheLinksAxes) {
  const RobotModel robot = parseRobot(
      R"(<link name="a"><inertial><origin xyz="0 0 1" rpy="0 0 0.5235987755982988"/><mass value="3"/>
         <inertia ixx="1" iyy="2" izz="2.5" ixy="0" ixz="0" iyz="0"/></inertial></link>)");
  const LinkModel& link = robot.links[0];
  EXPECT_EQ(link.centre_of_mass, Vector3(0, 0, 1));
  // R diag(1, 2) R^T with 30 degrees: xx = cos^2 + 2 sin^2, xy = (1 - 2) sin cos.
  EXPECT_NEAR(link.inertia(0, 0), 0.75 + 2 * 0.25, 1e-15);
  EXPECT_NEAR(link.inertia(1, 1), 0.25 + 2 * 0.75, 1e-15);
  EXPECT_NEAR(link.inertia(0, 1), -std::sqrt(0.75) / 2, 1e-15);
  EXPECT_NEAR(link.inertia(2, 2), 2.5, 1e-15);
}

TEST(UrdfReader, ReadsCollisionsAndOwnElements) {
  const RobotModel robot = parseRobot(
      R"(<link name="a"><visual><geometry><nonsense/></geometry></visual>
         <ambient medium="water" law="form" fluid_body="a.ambient" roughness="3e-5"/>
         <collision><geometry><box size="1 2 3"/></geometry></collision>
         <collision><geometry><capsule radius="0.5" length="2"/></geometry></collision>
         <collision><origin xyz="0 0 7"/><geometry><ellipsoid semi_axes="1 2 3"/></geometry></collision>
         <collision><geometry><cylinder radius="2" length="4"/></geometry></collision>
         <collision><geometry><mesh filename="m/b.obj" scale="1 2 -3"/></geometry></collision>
         </link><gazebo><plugin/></gazebo>)");
  const std::vector<PlacedShape>& parts = robot.links[0].collisions;
  ASSERT_EQ(parts.size(), 5u);
  EXPECT_EQ(std::get<Box>(parts[0].shape).half_sizes, Eigen::Vector3d(0.5, 1, 1.5));
  EXPECT_EQ(std::get<Capsule>(parts[1].shape).height, 2);
  EXPECT_EQ(std::get<Ellipsoid>(parts[2].shape).semi_axes, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(parts[2].pose.translation().z(), 7);
  EXPECT_EQ(std::get<Cylinder>(parts[3].shape).height, 4);
  EXPECT_EQ(std::get<MeshFile>(parts[4].shape).file, "m/b.obj");
  EXPECT_EQ(std::get<MeshFile>(parts[4].shape).stretch, Vector3(1, 2, -3));
  ASSERT_TRUE(robot.links[0].fluid);
  EXPECT_EQ(robot.links[0].fluid->medium, "water");
  EXPECT_EQ(robot.links[0].fluid->law, PressureLaw::kForm);
  EXPECT_EQ(robot.links[0].fluid->fluid_body, "a.ambient");
  EXPECT_EQ(robot.links[0].fluid->roughness, 3e-5);
}

TEST(UrdfReader, KindsOfJoints) {
  const std::string limit = R"(<limit lower="0" upper="1" effort="1" velocity="1"/>)";
  const RobotModel robot = parseRobot(
      massiveLink("a") + massiveLink("b") + massiveLink("c") + massiveLink("d") + massiveLink("e") +
      joint("ab", "continuous", "a", "b", R"(<mimic joint="bc" multiplier="2" offset="1"/>)") +
      joint("bc", "prismatic", "b", "c", limit) + joint("cd", "planar", "c", "d") +
      joint("de", "floating", "d", "e"));
  EXPECT_EQ(robot.links[1].joint.kind, UrdfJointKind::kRevolute);
  EXPECT_EQ(robot.links[1].joint.upper, JointModel::kUnlimited);
  ASSERT_TRUE(robot.links[1].joint.mimic);
  EXPECT_EQ(robot.links[1].joint.mimic->multiplier, 2);
  EXPECT_EQ(robot.links[1].joint.mimic->offset, 1);
  EXPECT_EQ(robot.links[2].joint.kind, UrdfJointKind::kPrismatic);
  EXPECT_EQ(robot.links[3].joint.kind, UrdfJointKind::kPlanar);
  EXPECT_EQ(robot.links[4].joint.kind, UrdfJointKind::kFloating);
}

TEST(UrdfReader, RefusesBadInputInOneLine) {
  expectRefusals(AMBIENT_ROBOT_REFUSALS, "robots", [](const std::string& content) {
    const std::string complaint = complaintAbout(content);
    EXPECT_EQ(complaint.find("r.urdf: "), 0u) << complaint;
    return complaint;
  });
}

TEST(UrdfReader, RefusesWhatIsNotARobot) {
  const auto complaint = [](const std::string& text) {
    return test::refusalOf([&] { parseUrdf(text, "r.urdf"); });
  };
  EXPECT_EQ(complaint("<sdf/>"), "r.urdf: has no element <robot>");
  EXPECT_NE(complaint("").find("r.urdf: "), std::string::npos);
  std::string deep;
  for (int i = 0; i < 100000; ++i) deep += "<a>";
  EXPECT_EQ(complaint(deep), "r.urdf: line 1: is not XML: XML_ELEMENT_DEPTH_EXCEEDED");
  EXPECT_THROW(readUrdf("no/such.urdf"), std::runtime_error);
  EXPECT_THROW(readUrdf("/"), std::runtime_error);
}

TEST(UrdfReader, ResultDoesNotDependOnTheLocale) {
  const test::CommaLocale locale;
  ASSERT_TRUE(locale.rulesTheCLibrary()) << "localedef of Debian's libc-bin is missing";
  std::ostringstream half;
  half << 0.5;
  ASSERT_EQ(half.str(), "0,5");
  const RobotModel robot = parseRobot(massiveLink("a", R"(<collision><geometry>
      <capsule radius="0.5" length="2.25"/></geometry></collision>)"));
  EXPECT_EQ(std::get<Capsule>(robot.links[0].collisions[0].shape).height, 2.25);
  EXPECT_EQ(robot.links[0].inertia(0, 0), 0.1);
}

namespace fs = std::filesystem;

TEST(FileReference, PathsAreBesideTheFile) {
  EXPECT_EQ(resolveReference("m/a.obj", "robots/r.urdf", {}, "r"), "robots/m/a.obj");
  EXPECT_EQ(resolveReference("/m/a.obj", "robots/r.urdf", {}, "r"), "/m/a.obj");
  EXPECT_EQ(resolveReference("file:///m/a.obj", "robots/r.urdf", {}, "r"), "/m/a.obj");
}

TEST(FileReference, PackagesAreFoundAboveTheFile) {
  const TemporaryFolder folder;
  const fs::path root = fs::path(folder / "");
  fs::create_directories(root / "rover/urdf");
  fs::create_directories(root / "arm");
  const fs::path file = root / "rover/urdf/r.urdf";
  const auto find = [&](const std::string& reference, const PackageFolders& packages = {}) {
    return fs::weakly_canonical(resolveReference(reference, file, packages, "r"));
  };
  const fs::path real = fs::canonical(root);
  EXPECT_EQ(find("package://rover/a.obj"), real / "rover/a.obj");
  EXPECT_EQ(find("model://arm/a.obj"), real / "arm/a.obj");
  EXPECT_EQ(find("package://arm/a.obj", {{"arm", "/given"}}), "/given/a.obj");
}

TEST(FileReference, RefusesWhatItCannotFind) {
  for (const char* bad :
       {"", "http://a/b", "package://no_such_package/a", "package://", "package://usr"})
    EXPECT_THROW(resolveReference(bad, "/usr/r.urdf", {}, "r"), std::runtime_error) << bad;
}

}  // namespace
}  // namespace ambient
