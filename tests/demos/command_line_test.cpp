#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include "tests/demos/scene/scene_text.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

namespace ambient {
namespace {

using Arguments = std::vector<std::string>;

ProgramResult demo(const Arguments& arguments) {
  return runProgram(AMBIENT_DEMO_PROGRAM, arguments);
}

/// Expects a run to fail with one line and to leave no files.
void expectRefusal(const nlohmann::json& scene, const Arguments& more, const std::string& message) {
  const TemporaryFolder input, output;
  Arguments arguments{writeScene(input, scene.dump()), "--out", output / "a/b"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const ProgramResult result = demo(arguments);
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.output, "");
  EXPECT_NE(result.errors.find(message), std::string::npos) << result.errors;
  EXPECT_EQ(result.errors.find('\n'), result.errors.size() - 1) << result.errors;
  EXPECT_TRUE(output.empty());
}

nlohmann::json smallBall() {
  nlohmann::json scene = ballScene();
  scene["bodies"][0]["shape"]["faces"] = 80;
  scene["duration"] = 0.1;
  return scene;
}

TEST(AmbientDemo, ListsItsScenes) {
  const ProgramResult result = demo({"--list"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_NE(result.output.find("plate_8cm "), std::string::npos);
  EXPECT_EQ(result.errors, "");
}

TEST(AmbientDemo, WritesTrajectorySummaryAndFluidBodies) {
  const TemporaryFolder input, output;
  const auto file = writeScene(input, smallBall().dump());
  const ProgramResult result =
      demo({file, "--quiet", "--out", output.path(), "--set", "model=vacuum"});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_EQ(result.output + result.errors, "");
  const auto summary = nlohmann::json::parse(readText(output / "summary.json"));
  EXPECT_EQ(summary["scene"], "ball");
  EXPECT_EQ(summary["model"], "vacuum");
  EXPECT_EQ(readText(output / "trajectory.csv")
                .rfind("time,body,px,py,pz,qw,qx,qy,qz,wx,wy,wz,vx,vy,vz\n", 0),
            0u);
  std::filesystem::remove(output / "summary.json");
  std::filesystem::remove(output / "trajectory.csv");
  std::filesystem::remove(output / "geometry.json");
  std::filesystem::remove_all(output / "fluid_bodies");
  EXPECT_TRUE(output.empty());
}

/// Cells of a line of a table.
std::vector<std::string> cellsOf(const std::string& line) {
  std::istringstream stream(line);
  std::vector<std::string> cells;
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
  return cells;
}

TEST(AmbientDemo, LogsWhatTheFluidDoes) {
  nlohmann::json scene = smallBall();
  scene["water"] = {{"level", 100}};
  const TemporaryFolder input, output, plain;
  const auto file = writeScene(input, scene.dump());
  const ProgramResult result =
      demo({file, "--quiet", "--out", output.path(), "--log", "wrench,wet"});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  std::istringstream stream(readText(output / "trajectory.csv"));
  std::vector<std::vector<std::string>> rows;
  for (std::string line; std::getline(stream, line);) rows.push_back(cellsOf(line));
  const auto valueOf = [&](const std::string& name) {
    const auto column = std::find(rows[0].begin(), rows[0].end(), name) - rows[0].begin();
    return std::stod(rows.back().at(static_cast<std::size_t>(column)));
  };
  for (const auto& row : rows) EXPECT_EQ(row.size(), 15u + 7 * 6 + 8);
  EXPECT_NEAR(valueOf("wet_share"), 1, 1e-12);
  EXPECT_NEAR(valueOf("buoyancy_fz"), 998 * 9.81 * valueOf("wet_volume"),
              0.02 * valueOf("buoyancy_fz"));
  EXPECT_EQ(valueOf("region"), 0);
  demo({file, "--quiet", "--out", plain.path()});
  std::istringstream without(readText(plain / "trajectory.csv"));
  for (const auto& row : rows) {
    std::string line;
    std::getline(without, line);
    EXPECT_EQ(cellsOf(line), std::vector<std::string>(row.begin(), row.begin() + 15));
  }
}

TEST(AmbientDemo, RefusesToLogWhatThereIsNot) {
  const ProgramResult result = demo({"sphere_fall", "--log", "wrench,colour"});
  EXPECT_NE(result.exit_code, 0);
  EXPECT_EQ(result.errors, "ambient_demo: --log: \"colour\" is none of wrench, wet, holds\n");
}

TEST(AmbientDemo, TheSameSceneGivesTheSameBytes) {
  const TemporaryFolder input, first, second;
  const auto file = writeScene(input, smallBall().dump());
  demo({file, "--quiet", "--out", first.path(), "--set", "threads=1"});
  demo({file, "--quiet", "--out", second.path(), "--set", "threads=3"});
  const std::string bytes = readText(first / "trajectory.csv");
  EXPECT_GT(bytes.size(), 100u);
  EXPECT_EQ(bytes, readText(second / "trajectory.csv"));
}

TEST(AmbientDemo, RefusesBadScenes) {
  nlohmann::json scene = smallBall();
  scene["bodies"][0]["colour"] = "red";
  expectRefusal(scene, {}, "ball.json: unknown key \"colour\" in bodies[0], which has ");
  expectRefusal(smallBall(), {"--set", "medium.density=-1"}, "medium.density is -1");
  expectRefusal(smallBall(), {"--set", "bodies.0.weight=1"},
                "unknown key \"weight\" in bodies[0], which has angular_velocity, ");
}

TEST(AmbientDemo, StopsWithoutATraceWhenAStateIsNotFinite) {
  expectRefusal(smallBall(), {"--quiet", "--set", "bodies.0.linear_velocity=[1e200, 0, 0]"},
                "body \"ball\": its state is not finite at t = 0.01 s");
}

TEST(AmbientDemo, LeavesNothingWhenItIsInterrupted) {
  nlohmann::json scene = smallBall();
  scene["model"] = "vacuum";  // nothing to solve: the run starts at once
  scene["duration"] = 1e7;
  const TemporaryFolder input, output;
  const ProgramResult result = interruptProgram(
      AMBIENT_DEMO_PROGRAM, {writeScene(input, scene.dump()), "--out", output / "a"}, 1000);
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.errors.find("interrupted"), std::string::npos) << result.errors;
  EXPECT_TRUE(output.empty());
}

TEST(AmbientDemo, ASecondSignalEndsItWithinAStepAndLeavesNothing) {
  nlohmann::json scene = smallBall();
  // Known added mass needs no solver; the run then is one step of a million substeps.
  scene["bodies"][0]["shape"] = {
      {"type", "ellipsoid"}, {"semi_axes", {1, 0.6, 0.3}}, {"faces", 20000}};
  scene["integrator"] = {{"method", "symplectic_euler"}, {"max_substeps", 1000000}};
  scene["time_step"] = scene["duration"] = 1e-3;
  const TemporaryFolder input, output;
  const std::string file = writeScene(input, scene.dump());
  const ProgramResult result =
      interruptProgram(AMBIENT_DEMO_PROGRAM, {file, "--out", output / "a/b"}, 1500, 2);
  EXPECT_EQ(result.exit_code, -1) << result.errors;
  EXPECT_TRUE(output.empty());
}

TEST(AmbientDemo, EscapesInNamesDoNotReachTheTerminal) {
  const TemporaryFolder input, output;
  const std::string escape = "\033[2J\u009b2J";
  for (const Arguments& arguments :
       {Arguments{"no" + escape}, Arguments{"plate_8cm", "--set", escape},
        Arguments{"plate_8cm", "--no" + escape}}) {
    const ProgramResult result = demo(arguments);
    EXPECT_NE(result.exit_code, 0);
    EXPECT_EQ((result.output + result.errors).find_first_of("\033\302"), std::string::npos);
  }
  const auto file = writeScene(input, smallBall().dump());
  const ProgramResult result = demo({file, "--out", output / escape, "--set", "model=vacuum"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ((result.output + result.errors).find_first_of("\033\302"), std::string::npos);
}

TEST(AmbientDemo, SaysThatItsFolderCannotBeMadeBeforeItReadsAMesh) {
  const TemporaryFolder folder;
  const std::string file = writeScene(folder, smallBall().dump());
  const std::string mesh = R"(bodies.0.shape={"type": "mesh", "file": "gone.obj"})";
  for (const std::string& out : {file, file + "/below"}) {
    const ProgramResult result = demo({file, "--out", out, "--set", mesh});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_EQ(result.errors.rfind("ambient_demo: " + out + ": cannot be made: ", 0), 0u)
        << result.errors;
  }
  std::filesystem::create_directory(folder / "out");
  std::filesystem::create_symlink("/dev/null", folder / "out/summary.json");
  const ProgramResult result = demo({file, "--out", folder / "out", "--set", mesh});
  EXPECT_NE(result.errors.find("summary.json: is not a regular file"), std::string::npos)
      << result.errors;
}

TEST(AmbientDemo, ASignalWhileAFlowIsSolvedLeavesNothing) {
  nlohmann::json scene = smallBall();
  scene["bodies"][0]["shape"] = {{"type", "mesh"}, {"file", AMBIENT_DATA "/meshes/bunny.obj"}};
  scene["bodies"][0]["waterline_table"] = 4;  // minutes of flows
  const TemporaryFolder input, output;
  const std::string file = writeScene(input, scene.dump());
  const ProgramResult result =
      interruptProgram(AMBIENT_DEMO_PROGRAM, {file, "--out", output / "a/b"}, 500);
  EXPECT_EQ(result.exit_code, -1) << result.errors;
  EXPECT_TRUE(output.empty());
}

TEST(AmbientDemo, RunsCasesByThePythonModule) {
  const TemporaryFolder folder;
  writeText(folder / "cases.jsonl",
            R"({"scene": ")" + (folder / "ball.json").string() + R"(", "set": {"duration": 0.1}})");
  writeText(folder / "ball.json", smallBall().dump());
  const ProgramResult result = demo({"--cases", (folder / "cases.jsonl").string(), "--shard", "0/1",
                                     "--out", (folder / "out").string()});
  if (AMBIENT_HAS_PYTHON) {
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_FALSE(std::filesystem::is_empty(folder / "out"));
  } else {
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_NE(result.errors.find("BULLET_AMBIENT_PYTHON=ON"), std::string::npos) << result.errors;
    EXPECT_EQ(result.errors.find('\n'), result.errors.size() - 1);
    EXPECT_FALSE(std::filesystem::exists(folder / "out"));
  }
}

TEST(AmbientDemo, RefusesAnUnknownScene) {
  const ProgramResult result = demo({"no_such_scene"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.errors.find("plate_8cm"), std::string::npos) << result.errors;
}

TEST(AmbientDemo, BadUsageExitsWithTwo) {
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{},
                                             {"plate_8cm", "--no-such-option"},
                                             {"plate_8cm", "--set", "duration"},
                                             {"plate_8cm", "plate_9cm"},
                                             {"plate_8cm", "--shard", "0/2"}}) {
    const ProgramResult result = demo(arguments);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(result.errors.find("ambient_demo: "), 0u) << result.errors;
  }
  EXPECT_EQ(demo({"--help"}).exit_code, 0);
}

}  // namespace
}  // namespace ambient
