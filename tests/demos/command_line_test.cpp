#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <fstream>

#include "tests/demos/scene_text.h"

namespace ambient {
namespace {

struct Outcome {
  int exit_code = -1;
  std::string output;
  std::string messages;
};

std::string contentsOf(const std::filesystem::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

Outcome demo(const std::string& arguments) {
  const TemporaryFolder folder;
  const std::string out = folder.path() / "stdout", err = folder.path() / "stderr";
  const int status = std::system(
      (AMBIENT_DEMO_PROGRAM " " + arguments + " >" + out + " 2>" + err + " </dev/null").c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, contentsOf(out), contentsOf(err)};
}

/// A run that must fail with one line and leave nothing.
void expectRefusal(const nlohmann::json& scene, const std::string& arguments,
                   const std::string& message) {
  const TemporaryFolder input, output;
  const auto file = writeScene(input, scene.dump());
  const Outcome outcome =
      demo(file.string() + " --out " + (output.path() / "a/b").string() + " " + arguments);
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_EQ(outcome.output, "");
  EXPECT_NE(outcome.messages.find(message), std::string::npos) << outcome.messages;
  EXPECT_EQ(outcome.messages.find('\n'), outcome.messages.size() - 1) << outcome.messages;
  EXPECT_TRUE(output.empty());
}

nlohmann::json smallBall() {
  nlohmann::json scene = ballScene();
  scene["bodies"][0]["shape"]["faces"] = 80;
  scene["duration"] = 0.1;
  return scene;
}

TEST(AmbientDemo, ListsItsScenes) {
  const Outcome outcome = demo("--list");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_NE(outcome.output.find("plate_8cm "), std::string::npos);
  EXPECT_EQ(outcome.messages, "");
}

TEST(AmbientDemo, WritesTrajectorySummaryAndFluidBodies) {
  const TemporaryFolder input, output;
  const auto file = writeScene(input, smallBall().dump());
  const Outcome outcome =
      demo(file.string() + " --quiet --out " + output.path().string() + " --set model=vacuum");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.messages;
  EXPECT_EQ(outcome.output + outcome.messages, "");
  const auto summary = nlohmann::json::parse(contentsOf(output.path() / "summary.json"));
  EXPECT_EQ(summary["scene"], "ball");
  EXPECT_EQ(summary["model"], "vacuum");
  EXPECT_EQ(contentsOf(output.path() / "trajectory.csv")
                .rfind("time,body,px,py,pz,qw,qx,qy,qz,wx,wy,wz,vx,vy,vz\n", 0),
            0u);
  std::filesystem::remove(output.path() / "summary.json");
  std::filesystem::remove(output.path() / "trajectory.csv");
  std::filesystem::remove(output.path() / "geometry.json");
  std::filesystem::remove_all(output.path() / "fluid_bodies");
  EXPECT_TRUE(output.empty());
}

TEST(AmbientDemo, TheSameSceneGivesTheSameBytes) {
  const TemporaryFolder input, first, second;
  const auto file = writeScene(input, smallBall().dump());
  demo(file.string() + " --quiet --out " + first.path().string() + " --set threads=1");
  demo(file.string() + " --quiet --out " + second.path().string() + " --set threads=3");
  const std::string bytes = contentsOf(first.path() / "trajectory.csv");
  EXPECT_GT(bytes.size(), 100u);
  EXPECT_EQ(bytes, contentsOf(second.path() / "trajectory.csv"));
}

TEST(AmbientDemo, RefusesBadScenes) {
  nlohmann::json scene = smallBall();
  scene["bodies"][0]["colour"] = "red";
  expectRefusal(scene, "", "ball.json: unknown key \"colour\" in bodies[0]");
  expectRefusal(smallBall(), "--set medium.density=-1", "medium.density is -1");
  expectRefusal(smallBall(), "--set bodies.0.weight=1", "a scene has no such key");
}

TEST(AmbientDemo, RefusesAMissingMesh) {
  expectRefusal(smallBall(), R"(--set 'bodies.0.shape={"type": "mesh", "file": "gone.obj"}')",
                "gone.obj");
}

TEST(AmbientDemo, StopsWithoutATraceWhenAStateIsNotFinite) {
  expectRefusal(smallBall(), "--quiet --set 'bodies.0.linear_velocity=[1e200, 0, 0]'",
                "body \"ball\": its state is not finite at t = 0.01 s");
}

TEST(AmbientDemo, RefusesALinearDragThatIsNotPositive) {
  expectRefusal(smallBall(), "--set model=uwrbd --set linear_drag_speed=0",
                "linear_drag_speed is 0; must be > 0 m/s");
}

TEST(AmbientDemo, RefusesAnUnknownScene) {
  const Outcome outcome = demo("no_such_scene");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.messages.find("plate_8cm"), std::string::npos) << outcome.messages;
}

TEST(AmbientDemo, BadUsageExitsWithTwo) {
  EXPECT_EQ(demo("").exit_code, 2);
  EXPECT_EQ(demo("plate_8cm --no-such-option").exit_code, 2);
  EXPECT_EQ(demo("plate_8cm --set duration").exit_code, 2);
  EXPECT_EQ(demo("plate_8cm plate_9cm").exit_code, 2);
  EXPECT_EQ(demo("--help").exit_code, 0);
}

}  // namespace
}  // namespace ambient
