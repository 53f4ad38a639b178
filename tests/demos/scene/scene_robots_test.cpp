#include <gtest/gtest.h>

#include <cmath>

#include "tests/demos/scene/scene_text.h"
#include "tests/support/refusal_of.h"
#include "tests/support/refusals.h"

namespace ambient {
namespace {

using nlohmann::json;

const char* const kTwoLinks = R"(<robot name="r">
  <link name="hull"><inertial><origin xyz="0 0 0.5"/><mass value="2"/>
    <inertia ixx="0.1" iyy="0.2" izz="0.25" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><geometry><sphere radius="0.1"/></geometry></collision></link>
  <link name="arm"><inertial><mass value="1"/>
    <inertia ixx="0.1" iyy="0.2" izz="0.25" ixy="0" ixz="0" iyz="0"/></inertial>
    <ambient medium="air" law="form" roughness="3e-5"/>
    <collision><geometry><sphere radius="0.1"/></geometry></collision></link>
  <link name="lamp"><inertial><mass value="1"/>
    <inertia ixx="0.1" iyy="0.2" izz="0.25" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="shoulder" type="continuous"><parent link="hull"/><child link="arm"/>
    <origin xyz="1 0 0"/><axis xyz="0 0 1"/></joint>
  <joint name="neck" type="planar"><parent link="hull"/><child link="lamp"/></joint>
</robot>)";

json robotScene() {
  return json::parse(R"({"duration": 2, "time_step": 0.01, "robots": [
      {"urdf": "r.urdf", "name": "rover", "position": [0, 0, 3],
       "orientation": [0.7071067811865476, 0, 0, 0.7071067811865476],
       "medium": {"density": 1000}, "separation_angle": 2,
       "motors": {"shoulder": {"position": 0.1, "amplitude": 0.5, "period": 4, "phase": 1}}}]})");
}

Scene readRobots(const json& scene) {
  const TemporaryFolder folder;
  writeText(folder / "r.urdf", kTwoLinks);
  return readScene(writeScene(folder, scene.dump()));
}

std::string complaintOf(const json& scene) {
  return test::refusalOf([&] { readRobots(scene); });
}

TEST(SceneRobots, LinksThatCollideAreBodies) {
  const Scene scene = readRobots(robotScene());
  ASSERT_EQ(scene.robots.size(), 1u);
  ASSERT_EQ(scene.bodies.size(), 2u);
  const BodyDef &hull = scene.bodies[0], &arm = scene.bodies[1];
  EXPECT_EQ(hull.name, "rover/hull");
  EXPECT_EQ(arm.name, "rover/arm");
  EXPECT_EQ(hull.mass, 2);
  // A quarter turn about z; the hull's centre of mass is half a metre above its origin.
  EXPECT_LT((hull.position - Vector3(0, 0, 3.5)).norm(), 1e-15);
  EXPECT_LT((arm.position - Vector3(0, 1, 3)).norm(), 1e-15);
  EXPECT_EQ(hull.attach.medium.density, 1000);
  EXPECT_EQ(arm.attach.medium.density, air().density);
  EXPECT_EQ(hull.attach.flow.law, PressureLaw::kForm);
  EXPECT_EQ(arm.attach.flow.law, PressureLaw::kForm);
  EXPECT_EQ(hull.attach.flow.separation_angle, 2);
  EXPECT_EQ(hull.attach.flow.roughness, 0);
  EXPECT_EQ(arm.attach.flow.roughness, 3e-5);
}

TEST(SceneRobots, MotorsFollowASine) {
  const Scene scene = readRobots(robotScene());
  const JointDrive& drive = scene.robots[0].motors.at("shoulder");
  const double rate = 2 * std::acos(-1.0) / 4;
  EXPECT_NEAR(drive.positionAt(0.3), 0.1 + 0.5 * std::sin(0.3 * rate + 1), 1e-15);
  EXPECT_NEAR(drive.velocityAt(0.3), 0.5 * rate * std::cos(0.3 * rate + 1), 1e-15);
  EXPECT_EQ(scene.robots[0].joint_positions.at("shoulder"), drive.positionAt(0));
  // The arm starts at its motor's target.
  const double turn =
      2 * std::atan2(scene.bodies[1].orientation.z(), scene.bodies[1].orientation.w());
  EXPECT_NEAR(turn, std::acos(-1.0) / 2 + drive.positionAt(0), 1e-14);
}

TEST(SceneRobots, RefusesWhatCannotBe) {
  expectRefusals(AMBIENT_SCENE_REFUSALS, "robots", [](const json& changes) {
    return complaintOf(withChanges(robotScene(), changes));
  });
  json twice = robotScene();
  twice["robots"].push_back(twice["robots"][0]);
  EXPECT_THROW(readRobots(twice), std::runtime_error);
}

const char* const kFixedMast = R"(<robot name="r">
  <link name="hull"><inertial><mass value="2"/>
    <inertia ixx="0.1" iyy="0.2" izz="0.25" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><geometry><sphere radius="0.1"/></geometry></collision></link>
  <link name="mast"><inertial><mass value="1"/>
    <inertia ixx="0.1" iyy="0.2" izz="0.25" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><geometry><sphere radius="0.1"/></geometry></collision></link>
  <joint name="foot" type="fixed"><parent link="hull"/><child link="mast"/>
    <origin xyz="0 0 3"/></joint>
</robot>)";

std::vector<double> massesWith(const json& robot) {
  const TemporaryFolder folder;
  writeText(folder / "r.urdf", kFixedMast);
  json scene = json::parse(R"({"duration": 1, "time_step": 0.01, "robots": [{"urdf": "r.urdf"}]})");
  scene["robots"][0].update(robot);
  std::vector<double> masses;
  for (const BodyDef& body : readScene(writeScene(folder, scene.dump())).bodies)
    masses.push_back(body.mass);
  return masses;
}

TEST(SceneRobots, FixedLinksAreMergedUnlessTheSceneSaysNo) {
  EXPECT_EQ(massesWith(json::object()), (std::vector<double>{3}));
  EXPECT_EQ(massesWith({{"merge_fixed_links", true}}), (std::vector<double>{3}));
  EXPECT_EQ(massesWith({{"merge_fixed_links", false}}), (std::vector<double>{2, 1}));
}

TEST(SceneRobots, SelfCollisionAndGainsAreThoseOfTheScene) {
  json scene = robotScene();
  EXPECT_FALSE(readRobots(scene).robots[0].self_collision);
  EXPECT_EQ(readRobots(scene).robots[0].motors.at("shoulder").velocity_gain, 1);
  scene["robots"][0]["self_collision"] = true;
  scene["robots"][0]["motors"]["shoulder"]["velocity_gain"] = 0.25;
  scene["robots"][0]["motors"]["shoulder"]["position_gain"] = 0.5;
  const RobotDef robot = readRobots(scene).robots[0];
  EXPECT_TRUE(robot.self_collision);
  EXPECT_EQ(robot.motors.at("shoulder").velocity_gain, 0.25);
  EXPECT_EQ(robot.motors.at("shoulder").position_gain, 0.5);
}

}  // namespace
}  // namespace ambient
