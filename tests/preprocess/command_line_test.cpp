#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "bullet_ambient/fluid_body/fluid_body_file.h"
#include "bullet_ambient/force/face_loads.h"
#include "preprocess/mesh/primitives.h"
#include "tests/demos/temporary_folder.h"
#include "tests/mesh/mesh_files.h"
#include "tests/mesh/mesh_fixtures.h"
#include "tests/preprocess/run_program.h"

namespace ambient {
namespace {

using nlohmann::json;
using Arguments = std::vector<std::string>;

class CommandLine : public ::testing::Test {
 protected:
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }

  std::string write(const std::string& name, const std::string& text) const {
    writeText(path(name), text);
    return path(name);
  }

  std::string bytesOfFile(const std::string& name) const {
    std::ostringstream bytes;
    bytes << std::ifstream(path(name), std::ios::binary).rdbuf();
    return bytes.str();
  }

  std::size_t fileCount() const {
    std::size_t count = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
      ++count;
    }
    return count;
  }

  static ProgramResult run(const Arguments& arguments) {
    return runProgram(AMBIENT_PREPROCESS, arguments);
  }

  static json resultOf(const Arguments& arguments) {
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_EQ(result.errors, "");
    return json::parse(result.output);
  }

  // Bad input: exit code 1, nothing on standard output, one line on standard error.
  static std::string refusal(const Arguments& arguments) {
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 1) << result.errors;
    EXPECT_EQ(result.output, "");
    EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1) << result.errors;
    const std::string beginning = "ambient_preprocess: ";
    EXPECT_EQ(result.errors.find(beginning), 0u) << result.errors;
    return result.errors.substr(beginning.size(), result.errors.size() - beginning.size() - 1);
  }

  // build of bad input, which must leave nothing behind.
  std::string buildRefusal(const std::string& input, const Arguments& more = {}) const {
    const std::size_t before = fileCount();
    Arguments arguments{"build", input, "-o", path("out.ambient")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const std::string message = refusal(arguments);
    EXPECT_EQ(fileCount(), before) << "a file was left behind";
    return message;
  }

  TemporaryFolder folder_;
};

std::string sphereText() { return R"({"type":"sphere","radius":0.5,"faces":320})"; }

TEST_F(CommandLine, BuildAndInspectPrintTheSameNumbers) {
  const std::string mesh =
      write("my cone.obj", objText(moved(makeConeMesh(0.5, 1, 300), {1, 2, 3})));
  const json built = resultOf({"build", mesh, "-o", path("cone.ambient"), "--json"});
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
                           "volume            0.523598776 m^3", "added mass per unit density"}) {
    EXPECT_NE(built.output.find(line), std::string::npos) << line << "\n" << built.output;
  }
  EXPECT_EQ(run({"inspect", path("ball.ambient")}).output, built.output);
}

TEST_F(CommandLine, BuildOptionsScaleShiftAndLimitThreads) {
  const std::string mesh = write("box.obj", objText(makeBoxMesh({1, 2, 3}, 200)));
  const Arguments common{"build", mesh, "-o", path("box.ambient"), "--panels", "600", "--json"};
  const auto with = [&](const Arguments& more) {
    Arguments arguments = common;
    arguments.insert(arguments.end(), more.begin(), more.end());
    return resultOf(arguments);
  };
  const json plain = with({});
  EXPECT_NEAR(plain["volume"].get<double>(), 48, 48e-6);
  EXPECT_NEAR(with({"--scale", "0.1"})["volume"].get<double>(), 0.048, 0.048e-6);
  const json shifted = with({"--origin", "-1,0.5,0"});
  EXPECT_EQ(shifted["origin"], json({-1.0, 0.5, 0.0}));
  EXPECT_NEAR(shifted["centre_of_volume"][0].get<double>(), 1, 1e-6);
  EXPECT_EQ(with({"--origin", "centre-of-volume"})["origin"], plain["origin"]);
  EXPECT_EQ(with({"--threads", "1", "--rebuild"})["added_mass"], plain["added_mass"]);
}

TEST_F(CommandLine, SheetsAreBuiltFromOpenMeshes) {
  const std::string mesh = write("sheet.obj", objText(makeRectangularSheetMesh(1, 1, 288)));
  const json sheet = resultOf({"build", mesh, "-o", path("s.ambient"), "--sheet", "--json"});
  EXPECT_EQ(sheet["volume"], 0.0);
  EXPECT_EQ(sheet["sheet"], true);
  EXPECT_EQ(sheet["faces"], 288);
  EXPECT_GT(sheet["added_mass"][5][5].get<double>(), 0.4);
  EXPECT_NE(buildRefusal(mesh).find("not watertight: 48 boundary edges"), std::string::npos);
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

TEST_F(CommandLine, BuildReplacesTheOutputAtOnceOrNotAtAll) {
  const std::string input = write("ball.json", sphereText());
  write("out.ambient", "something older");
  const std::string open = write("open.obj", objText(withoutTriangle(unitTetrahedron(), 0)));
  EXPECT_NE(buildRefusal(open), "");
  EXPECT_EQ(bytesOfFile("out.ambient"), "something older");
  resultOf({"build", input, "-o", path("out.ambient"), "--json"});
  EXPECT_EQ(readFluidBody(path("out.ambient")).name, "ball");
  EXPECT_EQ(fileCount(), 3u);
}

TEST_F(CommandLine, InterruptedBuildsLeaveNothing) {
  // Some seconds of work, interrupted early and late.
  const std::string input = write("ball.json", R"({"type":"sphere","radius":1,"faces":5000})");
  for (const int milliseconds : {5, 150}) {
    const ProgramResult result = interruptProgram(
        AMBIENT_PREPROCESS, {"build", input, "-o", path("out.ambient")}, milliseconds);
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

TEST_F(CommandLine, LoadsAreThoseOfTheForceModel) {
  resultOf({"build", write("ball.json", sphereText()), "-o", path("b.ambient"), "--json"});
  const json loads =
      resultOf({"loads", path("b.ambient"), "--twist", "0.1", "-2", ".3", "-1e-1", "-.5", "6",
                "--density", "1.2", "--viscosity", "1.8e-5", "--separation-angle", "2", "--json"});
  const FluidBody body = readFluidBody(path("b.ambient"));
  LoadSettings settings;
  settings.density = 1.2;
  settings.viscosity = 1.8e-5;
  settings.separation_cosine = std::cos(2.0);
  const Twist twist{{0.1, -2, 0.3}, {-0.1, -0.5, 6}};
  const FaceLoads expected = computeFaceLoads(body.faces, std::sqrt(body.area), twist, settings);
  for (int i = 0; i < 6; ++i) {
    EXPECT_EQ(loads["pressure"][i].get<double>(), expected.pressure.vector()[i]);
    EXPECT_EQ(loads["friction"][i].get<double>(), expected.friction.vector()[i]);
    EXPECT_EQ(loads["total"][i].get<double>(), expected.total().vector()[i]);
  }
  EXPECT_LT(loads["friction"][5].get<double>(), 0);
  EXPECT_LT(loads["pressure"][5].get<double>(), 0);
}

TEST_F(CommandLine, LoadsSeparateAtARightAngleByDefault) {
  resultOf({"build", write("ball.json", R"({"type":"sphere","radius":0.5})"), "-o",
            path("b.ambient"), "--json"});
  const Arguments motion{"loads", path("b.ambient"), "--twist", "0",     "0", "0", "0", "0",
                         "2",     "--density",       "3",       "--json"};
  const json loads = resultOf(motion);
  // C_D = 1/2 on pi R^2 (sin^4(alpha) / 2, integrated); 0.1 % from the facets.
  const double drag = 0.5 * 3 * 2 * 2 * 0.5 * 3.14159265358979 * 0.25;
  EXPECT_NEAR(loads["pressure"][5].get<double>(), -drag, 2e-3 * drag);
  EXPECT_EQ(loads["friction"][5].get<double>(), 0) << "no viscosity, no friction";
  Arguments right_angle = motion;
  right_angle.insert(right_angle.end(), {"--separation-angle", "1.5707963"});
  EXPECT_EQ(resultOf(right_angle), loads);
  Arguments without = motion;
  without.insert(without.end(), {"--viscosity", "1e-3", "--no-friction"});
  EXPECT_EQ(resultOf(without), loads);
}

TEST_F(CommandLine, LoadsPrintATable) {
  resultOf({"build", write("ball.json", sphereText()), "-o", path("b.ambient"), "--json"});
  const ProgramResult loads =
      run({"loads", path("b.ambient"), "--twist", "0", "0", "0", "1", "0", "0", "--density", "1"});
  EXPECT_EQ(loads.exit_code, 0);
  EXPECT_NE(loads.output.find("\npressure "), std::string::npos) << loads.output;
  EXPECT_NE(loads.output.find("\ntotal "), std::string::npos) << loads.output;
}

TEST_F(CommandLine, BadUsageEndsWithTwo) {
  const std::string ball = write("ball.json", sphereText());
  for (const Arguments& arguments : std::vector<Arguments>{
           {},
           {"bild"},
           {"build"},
           {"build", ball},
           {"build", ball, "-o"},
           {"build", ball, "-o", path("out.ambient"), "--scael", "1"},
           {"build", ball, "-o", path("out.ambient"), "--scale", "large"},
           {"build", ball, "-o", path("out.ambient"), "--threads", "1.5"},
           {"build", ball, ball, "-o", path("out.ambient")},
           {"inspect"},
           {"loads", "x.ambient"},
           {"loads", "x.ambient", "--density", "1"},
           {"loads", "x.ambient", "--density", "1", "--twist", "1", "2", "3", "4", "5"},
           {"loads", "x.ambient", "--density", "1", "--twist", "1", "2", "3", "4", "5", "six"}}) {
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 2) << result.errors;
    EXPECT_EQ(result.output, "");
    EXPECT_NE(result.errors, "");
    EXPECT_EQ(fileCount(), 1u);
  }
}

TEST_F(CommandLine, ReportEstimatesTheErrorOfAMesh) {
  const std::string mesh = write("box.obj", objText(makeBoxMesh({1, 2, 3}, 12)));
  const json report = resultOf({"report", mesh, "--scale", "0.1", "--panels", "800", "--json"});
  EXPECT_EQ(report["faces"], 12);
  EXPECT_GT(report["built"]["panels"], report["other"]["panels"]);
  EXPECT_GT(report["rotation_error"].get<double>(), 1e-3);
  EXPECT_LT(report["rotation_error"].get<double>(), 0.2);
  EXPECT_NEAR(report["thinnest"]["thickness"].get<double>(), 0.2, 1e-6);
  EXPECT_EQ(report["worst_triangles"].size(), 3u);
  const ProgramResult table = run({"report", mesh, "--panels", "800"});
  EXPECT_EQ(table.exit_code, 0);
  EXPECT_NE(table.output.find("\nestimated error  "), std::string::npos) << table.output;
  const std::string open = write("open.obj", objText(withoutTriangle(unitTetrahedron(), 0)));
  EXPECT_EQ(refusal({"report", open}).find(open + ": not watertight"), 0u);
  EXPECT_EQ(refusal({"report", mesh, "--panels", "-1"}),
            "--panels: -1 is below 0 (0: no division)");
}

TEST_F(CommandLine, MistypedCommandsAreCorrected) {
  EXPECT_EQ(run({"bild"}).errors,
            "ambient_preprocess: unknown command 'bild'; did you mean 'build'?\n");
  EXPECT_EQ(run({"inpsect", "x"}).errors,
            "ambient_preprocess: unknown command 'inpsect'; did you mean 'inspect'?\n");
  EXPECT_EQ(run({"something"}).errors,
            "ambient_preprocess: unknown command 'something'; --help lists them\n");
  EXPECT_EQ(run({"something"}).exit_code, 2);
}

TEST_F(CommandLine, NamesThatAreNotUtf8AreShownWithReplacements) {
  resultOf({"build", write("ball.json", sphereText()), "-o", path("b.ambient"), "--json"});
  FluidBody body = readFluidBody(path("b.ambient"));
  body.name = "caf\xe9";
  writeFluidBody(body, path("b.ambient"));
  EXPECT_EQ(resultOf({"inspect", path("b.ambient"), "--json"})["name"], "caf\xef\xbf\xbd");
}

TEST_F(CommandLine, HelpAndVersionEndWithZero) {
  for (const Arguments& arguments :
       std::vector<Arguments>{{"--help"}, {"build", "--help"}, {"--version"}}) {
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_NE(result.output, "");
    EXPECT_EQ(result.errors, "");
  }
}

TEST_F(CommandLine, BadMeshesAreRefusedInOneLineThatNamesTheFile) {
  const TriangleMesh tetrahedron = unitTetrahedron();
  const std::string missing = path("no such.obj");
  EXPECT_EQ(buildRefusal(missing), missing + ": no such file");
  const std::string foreign = write("notes.txt", "these are notes");
  EXPECT_EQ(buildRefusal(foreign).find(foreign + ": cannot be read as a mesh: "), 0u);
  const std::string open = write("open.obj", objText(withoutTriangle(tetrahedron, 3)));
  EXPECT_EQ(buildRefusal(open).find(open + ": not watertight: 3 boundary edges, for example from "
                                           "vertex "),
            0u);
  const std::string flat = write("flat.obj", objText(makeEllipsoidMesh({1, 1, 1e-7}, 320)));
  EXPECT_EQ(buildRefusal(flat).find(flat + ": "), 0u);
  std::string text = objText(tetrahedron);
  text.replace(text.find("v 1 0 0"), 7, "v 1 nan 0");
  const std::string nan = write("nan.obj", text);
  EXPECT_EQ(buildRefusal(nan).find(nan + ": vertex "), 0u);
  EXPECT_NE(buildRefusal(nan).find(" = nan, must be finite"), std::string::npos);
  const std::string closed = write("closed.obj", objText(tetrahedron));
  EXPECT_NE(buildRefusal(closed, {"--sheet"}).find("is closed: a sheet needs a boundary"),
            std::string::npos);
}

TEST_F(CommandLine, BadShapesAreRefusedInOneLineThatNamesTheFile) {
  const std::string typo = write("typo.json", R"({"type":"sphere","radios":1})");
  EXPECT_EQ(buildRefusal(typo).find(typo + ": "), 0u);
  const std::string negative = write("negative.json", R"({"type":"sphere","radius":-1})");
  EXPECT_EQ(buildRefusal(negative).find(negative + ": radius = -1 in shape \"sphere\""), 0u);
  const std::string lost = write("lost.json", R"({"type":"mesh","file":"lost.obj"})");
  EXPECT_EQ(buildRefusal(lost), path("lost.obj") + ": no such file");
  const std::string built = write("built.json", R"({"type":"fluid_body","file":"x.ambient"})");
  EXPECT_EQ(buildRefusal(built), built + ": a shape \"fluid_body\" is built already");
  const std::string ball = write("ball.json", sphereText());
  EXPECT_EQ(buildRefusal(ball, {"--sheet"}), ball + ": --sheet needs a shape of type \"sheet\"");
}

TEST_F(CommandLine, BadValuesOfOptionsAreRefusedByName) {
  const std::string ball = write("ball.json", sphereText());
  EXPECT_EQ(buildRefusal(ball, {"--scale", "0"}), ball + ": scale = 0 is not positive and finite");
  EXPECT_EQ(buildRefusal(ball, {"--scale", "nan"}),
            ball + ": scale = nan is not positive and finite");
  EXPECT_EQ(buildRefusal(ball, {"--threads", "-1"}), "--threads: -1 is below 0 (0: all cores)");
  EXPECT_EQ(buildRefusal(ball, {"--threads", "1000"}), "--threads: 1000 is above 256");
  EXPECT_EQ(buildRefusal(ball, {"--panels", "2000000"}),
            ball + ": panels = 2000000 is above 1000000");
  EXPECT_EQ(buildRefusal(ball, {"--solver", "sparse"}),
            "--solver: \"sparse\" is neither dense nor hierarchical");
  EXPECT_EQ(buildRefusal(ball, {"--memory", "-2"}),
            "--memory: \"-2\" is not a number of gigabytes above 0");
  EXPECT_NE(buildRefusal(ball, {"--memory", "0.001"}).find("GB of memory, more than the 0.001 GB"),
            std::string::npos);
  for (const char* origin : {"1,2", "1,2,3,4", "a,b,c", "1,2,inf", "centre", "1,2,3x", "nan,0,0"}) {
    EXPECT_EQ(buildRefusal(ball, {"--origin", origin}),
              "--origin: \"" + std::string(origin) +
                  "\" is neither centre-of-volume nor three finite numbers X,Y,Z");
  }
  const std::string nowhere = path("no folder/out.ambient");
  EXPECT_EQ(refusal({"build", ball, "-o", nowhere}),
            nowhere + ": the directory \"" + path("no folder") + "\" does not exist");
  EXPECT_EQ(refusal({"build", ball, "-o", ball}), ball + ": the output would replace the input");
  EXPECT_EQ(bytesOfFile("ball.json"), sphereText());
}

TEST_F(CommandLine, BadLoadsAreRefusedByName) {
  resultOf({"build", write("ball.json", sphereText()), "-o", path("b.ambient"), "--json"});
  const auto with = [&](const Arguments& more, const std::string& density = "1") {
    Arguments arguments{"loads", path("b.ambient"), "--twist", "0", "0", "0", "1", "0",
                        "0",     "--density",       density};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return refusal(arguments);
  };
  EXPECT_EQ(with({}, "-1"), "--density: -1 kg/m^3 must be finite and not negative");
  EXPECT_EQ(with({}, "inf"), "--density: inf kg/m^3 must be finite and not negative");
  EXPECT_EQ(with({"--viscosity", "-1"}), "--viscosity: -1 Pa s must be finite and not negative");
  EXPECT_EQ(with({"--separation-angle", "1.5"}),
            "--separation-angle: 1.5 rad must lie between pi/2 and pi");
  EXPECT_EQ(with({"--separation-angle", "4"}),
            "--separation-angle: 4 rad must lie between pi/2 and pi");
  EXPECT_EQ(refusal({"loads", path("b.ambient"), "--twist", "0", "0", "0", "nan", "0", "0",
                     "--density", "1"}),
            "--twist: number 4 is nan, must be finite");
}

TEST_F(CommandLine, BadAmbientFilesAreRefusedByInspectAndLoads) {
  resultOf({"build", write("ball.json", sphereText()), "-o", path("b.ambient"), "--json"});
  const std::string bytes = bytesOfFile("b.ambient");
  std::string flipped = bytes;
  flipped[bytes.size() / 2] = static_cast<char>(flipped[bytes.size() / 2] ^ 1);
  for (const std::string& file :
       {path("missing.ambient"), write("empty.ambient", ""), write("foreign.ambient", "solid x"),
        write("short.ambient", bytes.substr(0, bytes.size() / 2)),
        write("flipped.ambient", flipped), write("mesh.obj", objText(unitTetrahedron()))}) {
    EXPECT_NE(refusal({"inspect", file}).find(file), std::string::npos);
    EXPECT_NE(refusal({"loads", file, "--twist", "0", "0", "0", "1", "0", "0", "--density", "1"})
                  .find(file),
              std::string::npos);
  }
}

}  // namespace
}  // namespace ambient
