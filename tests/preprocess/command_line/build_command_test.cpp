#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "bullet_ambient/fluid_body/file/fluid_body_file.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "tests/preprocess/command_line/command_line.h"
#include "tests/preprocess/mesh/mesh_fixtures.h"

namespace ambient {
namespace {

using nlohmann::json;

TEST_F(CommandLine, BuildAndInspectPrintTheSameNumbers) {
  const std::string mesh =
      write("my cone.obj", objText(moved(makeConeMesh(0.5, 1, 300), {1, 2, 3})));
  const json built =
      resultOf({"build", mesh, "-o", path("cone.ambient"), "--panels", "0", "--json"});
  EXPECT_EQ(built["name"], "my cone");
  EXPECT_EQ(built["faces"], 224);
  EXPECT_EQ(built["vertices"], 114);
  EXPECT_GT(built["seconds"].get<double>(), 0);
  EXPECT_NEAR(built["volume"].get<double>(), 3.14159265 / 12, 0.02 * 3.14159265 / 12);
  EXPECT_GT(built["area"].get<double>(), 0);
  EXPECT_GE(built["asymmetry"].get<double>(), 0);
  EXPECT_NEAR(built["origin"][0].get<double>(), 1, 1e-6);
  EXPECT_NEAR(built["origin"][2].get<double>(), 3 - 0.25, 2e-3);
  EXPECT_EQ(built["centre_of_volume"], json({0.0, 0.0, 0.0}));
  ASSERT_EQ(built["added_mass"].size(), 6u);
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) EXPECT_EQ(built["added_mass"][i][j], built["added_mass"][j][i]);
  }
  json inspected = resultOf({"inspect", path("cone.ambient"), "--json"});
  inspected["seconds"] = built["seconds"];
  EXPECT_EQ(inspected, built);
}

TEST_F(CommandLine, NumbersAreThoseOfTheFileToTheLastBit) {
  const std::string input = write("ball.json", sphereText());
  const json built = resultOf({"build", input, "-o", path("ball.ambient"), "--json"});
  const FluidBody body = readFluidBody(path("ball.ambient"));
  EXPECT_EQ(built["volume"].get<double>(), body.volume);
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) {
      EXPECT_EQ(built["added_mass"][i][j].get<double>(), body.added_mass(i, j));
    }
  }
}

TEST_F(CommandLine, TablesSayWhatTheJsonSays) {
  const std::string input = write("ball.json", sphereText());
  const ProgramResult built = run({"build", input, "-o", path("ball.ambient")});
  EXPECT_EQ(built.exit_code, 0);
  EXPECT_EQ(built.errors, "");
  for (const char* line : {"vertices          162", "faces             320",
                           "volume            0.523598776 m^3", "\nadded mass "}) {
    EXPECT_NE(built.output.find(line), std::string::npos) << line << "\n" << built.output;
  }
  EXPECT_EQ(run({"inspect", path("ball.ambient")}).output, built.output);
}

TEST_F(CommandLine, BuildOptionsScaleShiftAndLimitThreads) {
  const std::string mesh = write("box.obj", objText(makeBoxMesh({1, 2, 3}, 200)));
  const Arguments common{"build", mesh, "-o", path("box.ambient"), "--panels", "0", "--json"};
  const auto with = [&](const Arguments& more) { return resultOf(appended(common, more)); };
  const json plain = with({});
  EXPECT_NEAR(plain["volume"].get<double>(), 48, 48e-6);
  EXPECT_NEAR(with({"--scale", "0.1"})["volume"].get<double>(), 0.048, 0.048e-6);
  const json shifted = with({"--origin", "-1,0.5,0"});
  EXPECT_EQ(shifted["origin"], json({-1.0, 0.5, 0.0}));
  EXPECT_NEAR(shifted["centre_of_volume"][0].get<double>(), 1, 1e-6);
  EXPECT_EQ(with({"--origin", "centre-of-volume"})["origin"], plain["origin"]);
  EXPECT_EQ(with({"--threads", "1", "--rebuild"})["added_mass"], plain["added_mass"]);
}

TEST_F(CommandLine, MeshesInMillimetresAreWarnedOfAndSizesShown) {
  const std::string mesh = write("box.obj", objText(makeBoxMesh({400, 250, 100}, 200)));
  const Arguments build{"build", mesh, "-o", path("box.ambient"), "--panels", "0"};
  const std::string warning =
      "warning: " + mesh +
      ": its size is 800 x 500 x 200 m; lengths are metres: if the file is in "
      "millimetres, --scale 0.001\n";
  const ProgramResult built = run(build);
  EXPECT_EQ(built.exit_code, 0);
  EXPECT_EQ(built.errors, warning);
  EXPECT_NE(built.output.find("\nsize              800, 500, 200 m\n"), std::string::npos);
  const ProgramResult check = run({"check", mesh});
  EXPECT_EQ(check.errors, warning);
  EXPECT_NE(check.output.find("\nsize              800, 500, 200 m\n"), std::string::npos);
  Arguments scaled = build;
  scaled.insert(scaled.end(), {"--scale", "0.001", "--json"});
  const json size = resultOf(scaled)["size"];
  EXPECT_NEAR(size[0].get<double>(), 0.8, 1e-6);
  EXPECT_NEAR(size[1].get<double>(), 0.5, 1e-6);
  EXPECT_NEAR(size[2].get<double>(), 0.2, 1e-6);
  scaled[scaled.size() - 2] = "2";  // whoever scales knows the unit
  EXPECT_EQ(run(scaled).errors, "");
  scaled[scaled.size() - 2] = "1e-6";
  EXPECT_NE(run(scaled).errors.find("; lengths are metres: if the file is in others"),
            std::string::npos);
  scaled[scaled.size() - 2] = "1e-8";
  EXPECT_EQ(run(scaled).errors, "warning: " + mesh +
                                    ": its size is 8e-06 x 5e-06 x 2e-06 m; lengths are metres: "
                                    "if the file is in others, --scale FACTOR\n");
}

TEST_F(CommandLine, SlenderShapesAreWarnedOf) {
  const auto warningsOf = [&](const std::string& shape) {
    return run({"build", write("s.json", shape), "-o", path("s.ambient"), "--panels", "0"}).errors;
  };
  EXPECT_EQ(warningsOf(R"({"type":"sheet","size":[0.001,1],"faces":400})"),
            "warning: " + path("s.json") +
                ": it is 1000 times as long as wide: the added mass may be some per cent off\n");
  EXPECT_EQ(warningsOf(R"({"type":"sheet","size":[0.01,1],"faces":400})"), "");
}

// OBJ text of a cylinder in a CAD program's style: strips from rim to rim, caps as fans.
std::string cylinderOfStrips(int strips) {
  std::string vertices, triangles;
  const auto add = [](std::string& to, const char* key, const auto& a, const auto& b,
                      const auto& c) {
    std::ostringstream line;
    line << key << ' ' << a << ' ' << b << ' ' << c << '\n';
    to += line.str();
  };
  for (const double z : {-0.5, 0.5})
    for (int i = 0; i < strips; ++i) {
      const double angle = 2 * std::acos(-1.0) * i / strips;
      add(vertices, "v", 0.5 * std::cos(angle), 0.5 * std::sin(angle), z);
    }
  for (const double z : {-0.5, 0.5}) add(vertices, "v", 0, 0, z);
  for (int i = 1; i <= strips; ++i) {
    const int next = i % strips + 1;
    add(triangles, "f", i, next, strips + next);
    add(triangles, "f", i, strips + next, strips + i);
    add(triangles, "f", 2 * strips + 1, next, i);
    add(triangles, "f", 2 * strips + 2, strips + i, strips + next);
  }
  return vertices + triangles;
}

TEST_F(CommandLine, LongTrianglesGetMorePanelsOrAWarning) {
  const auto errorsOf = [&](const std::string& name, const std::string& text, const char* panels) {
    return run({"build", write(name, text), "-o", path(name + ".ambient"), "--panels", panels})
        .errors;
  };
  const std::string warning =
      "warning: " + path("strips.obj") +
      ": its long triangles leave too few panels across its edges: the added mass may be some, at "
      "worst tens of per cent off; cut them into shorter ones, or give more panels\n";
  const std::string strips = errorsOf("strips.obj", cylinderOfStrips(24), "300");
  EXPECT_NE(strips.find(warning), std::string::npos) << strips;
  const std::string few = errorsOf("few.obj", cylinderOfStrips(12), "600");
  EXPECT_EQ(few.find("long triangles"), std::string::npos) << few;
  const FluidBody body = readFluidBody(path("few.obj.ambient"));
  // Solved on 17 000 panels; 600 panels alone are 9 % off.
  EXPECT_NEAR(body.added_mass(0, 0), 0.023918, 0.02 * 0.023918);
}

TEST_F(CommandLine, SheetsAreBuiltFromOpenMeshes) {
  const std::string mesh = write("sheet.obj", objText(makeRectangularSheetMesh(1, 1, 288)));
  const json sheet = resultOf({"build", mesh, "-o", path("s.ambient"), "--sheet", "--json"});
  EXPECT_EQ(sheet["volume"], 0.0);
  EXPECT_EQ(sheet["sheet"], true);
  EXPECT_EQ(sheet["faces"], 288);
  EXPECT_GT(sheet["added_mass"][5][5].get<double>(), 0.4);
  EXPECT_NE(buildRefusal(mesh).find("not watertight: 48 boundary edges"), std::string::npos);
  EXPECT_NE(buildRefusal(mesh).find("--sheet"), std::string::npos);
}

TEST_F(CommandLine, InsideOutMeshesAreTurnedWithAWarning) {
  const std::string mesh = write("ball.obj", objText(insideOut(makeEllipsoidMesh({1, 1, 1}, 320))));
  const ProgramResult built = run({"build", mesh, "-o", path("ball.ambient"), "--json"});
  EXPECT_EQ(built.exit_code, 0);
  EXPECT_EQ(built.errors, "warning: " + mesh +
                              ": inside out, 320 of 320 triangles were turned round to point into "
                              "the fluid\n");
  EXPECT_GT(json::parse(built.output)["volume"].get<double>(), 4);
}

TEST_F(CommandLine, HollowMeshesDisplaceWhatTheirOutsideEncloses) {
  const TriangleMesh hollow =
      joined(makeBoxMesh({1, 1, 1}, 300), insideOut(makeBoxMesh({0.5, 0.5, 0.5}, 48)));
  const std::string mesh = write("hollow.obj", objText(hollow));
  const ProgramResult built =
      run({"build", mesh, "-o", path("hollow.ambient"), "--panels", "0", "--json"});
  EXPECT_EQ(built.exit_code, 0);
  EXPECT_EQ(built.errors.find("warning: " + mesh + ": 1 cavity of 12.5 % of the volume: "), 0u);
  EXPECT_NEAR(json::parse(built.output)["volume"].get<double>(), 8, 1e-5);
  // Uniform mass of the hollow cube; a full cube would have 2/3.
  const FluidBody body = readFluidBody(path("hollow.ambient"));
  EXPECT_NEAR(body.uniform_mass.inertia(0, 0), (8 * 2.0 / 3 - 1 / 6.0) / 7, 1e-5);
}

TEST_F(CommandLine, InterruptedBuildsLeaveNothing) {
  // Work of some seconds, interrupted early and late.
  const std::string input = write("box.json", R"({"type":"box","size":[1,2,3]})");
  for (const int milliseconds : {5, 150}) {
    const ProgramResult result = interruptProgram(
        AMBIENT_PREPROCESS,
        {"build", input, "-o", path("out.ambient"), "--no-tables", "--panels", "8000"},
        milliseconds);
    EXPECT_EQ(result.exit_code, -1);
    EXPECT_EQ(fileCount(), 1u);
  }
}

TEST_F(CommandLine, BuildKeepsAFileThatIsStillRight) {
  const std::string input = write("ball.json", sphereText());
  const Arguments arguments{"build", input, "-o", path("ball.ambient"), "--json"};
  json built = resultOf(arguments);
  const auto time = std::filesystem::last_write_time(path("ball.ambient"));
  json kept = resultOf(arguments);
  EXPECT_EQ(std::filesystem::last_write_time(path("ball.ambient")), time);
  kept["seconds"] = built["seconds"];
  EXPECT_EQ(kept, built);
  write("ball.json", R"({"type":"sphere","radius":0.6,"faces":320})");
  EXPECT_GT(resultOf(arguments)["volume"].get<double>(), 1.5 * built["volume"].get<double>());
}

TEST_F(CommandLine, LevelsAreThoseAskedForWithTheirErrors) {
  const std::string input =
      write("egg.json", R"({"type":"ellipsoid","semi_axes":[0.2,0.2,0.1],"faces":320})");
  const std::string output = path("egg.ambient");
  const json plain = resultOf({"build", input, "-o", output, "--json"});
  EXPECT_EQ(plain.count("form_levels"), 0u);
  const json built = resultOf({"build", input, "-o", output, "--levels", "16,32", "--json"});
  ASSERT_EQ(built["form_levels"].size(), 2u);
  for (const json& level : built["form_levels"]) EXPECT_GT(level["p99_error"].get<double>(), 0);
  EXPECT_LE(built["form_levels"][0]["faces"], 16);
  EXPECT_LT(built["form_levels"][0]["faces"], built["form_levels"][1]["faces"]);
  EXPECT_EQ(readFluidBody(output).form_levels.size(), 2u);
}

TEST_F(CommandLine, WithoutTablesTheFlowAroundABoxIsSolved) {
  const std::string box = write("box.json", R"({"type": "box", "size": [1, 2, 3]})");
  const auto settingsOf = [&](const Arguments& more) {
    const Arguments build{"build", box, "-o", path("box.ambient"), "--json", "--panels", "1200"};
    return resultOf(appended(build, more))["settings"].get<std::string>();
  };
  const std::string looked_up = settingsOf({}), solved = settingsOf({"--no-tables"});
  EXPECT_NE(looked_up.find("added mass tables"), std::string::npos) << looked_up;
  EXPECT_EQ(solved.find("added mass tables"), std::string::npos) << solved;
  EXPECT_NE(solved.find("panels"), std::string::npos) << solved;
}

}  // namespace
}  // namespace ambient
