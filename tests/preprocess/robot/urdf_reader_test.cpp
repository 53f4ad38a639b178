#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <sstream>

#include "preprocess/robot/robot_model.h"
#include "tests/preprocess/robot/urdf_text_of.h"
#include "tests/support/comma_locale.h"
#include "tests/support/refusal_of.h"
#include "tests/support/refusals.h"
#include "tests/support/temporary_folder.h"

namespace ambient {
namespace {

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
         <ambient medium="water" law="form" fluid_body="a.ambient"/>
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
