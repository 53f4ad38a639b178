// Output files: places, links, names, and existing files there.

#include "tests/preprocess/command_line/command_line.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <utility>
#include <vector>

#include "bullet_ambient/fluid_body/file/fluid_body_file.h"
#include "preprocess/base/fluid_body_writer.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "tests/preprocess/mesh/mesh_fixtures.h"

namespace ambient {
namespace {

using nlohmann::json;

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
           {"build", ball, "-o", path("out.ambient"), "--threads", "99999999999999999999"},
           {"build", ball, "-o", path("out.ambient"), "--levels", "16,x"},
           {"inspect"},
           {"inspect", ball, "--jsn"},
           {"check", ball, "--panels", "many"},
           {"polar"},
           {"polar", ball, "--speed", "fast"},
           {"loads", "x.ambient"},
           {"loads", "x.ambient", "--density", "1"},
           {"loads", "x.ambient", "--density", "1", "--twist", "1", "2", "3", "4", "5"},
           {"loads", "x.ambient", "--density", "1", "--twist", "1", "2", "3", "4", "5", "six"}}) {
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 2) << result.errors;
    EXPECT_EQ(result.output, "");
    EXPECT_EQ(result.errors.find("ambient_preprocess: "), 0u) << result.errors;
    EXPECT_EQ(fileCount(), 1u);
  }
}

TEST_F(CommandLine, EmptyArgumentsAreNotZero) {
  EXPECT_EQ(usageRefusal(
                {"loads", "x.ambient", "--density", "", "--twist", "0", "0", "0", "1", "0", "0"}),
            "argument 4 is empty");
  EXPECT_EQ(usageRefusal({"inspect", ""}), "argument 2 is empty");
}

TEST_F(CommandLine, CheckEstimatesTheErrorOfAMesh) {
  const std::string mesh = write("box.obj", objText(makeBoxMesh({1, 2, 3}, 12)));
  const json report =
      resultOf({"check", mesh, "--scale", "0.1", "--estimate", "--panels", "800", "--json"});
  EXPECT_EQ(report["faces"], 12);
  const json& estimate = report["estimate"];
  EXPECT_GT(estimate["panels"], estimate["other_panels"]);
  EXPECT_GT(estimate["rotation_error"].get<double>(), 1e-3);
  EXPECT_LT(estimate["rotation_error"].get<double>(), 0.2);
  EXPECT_NEAR(estimate["thinnest"]["thickness"].get<double>(), 0.2, 1e-6);
  EXPECT_EQ(estimate["worst_triangles"].size(), 3u);
  EXPECT_FALSE(resultOf({"check", mesh, "--json"}).contains("estimate"));
  const ProgramResult table = run({"check", mesh, "--estimate", "--panels", "800"});
  EXPECT_EQ(table.exit_code, 0);
  EXPECT_NE(table.output.find("\nestimate\n"), std::string::npos) << table.output;
  const std::string open = write("open.obj", objText(withoutTriangle(unitTetrahedron(), 0)));
  const ProgramResult refused = run({"check", open, "--estimate", "--strict"});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_EQ(refused.output.find("estimate"), std::string::npos) << refused.output;
  EXPECT_EQ(usageRefusal({"check", mesh, "--estimate", "--panels", "-1"}),
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

namespace fs = std::filesystem;

TEST_F(CommandLine, BuildReplacesTheOutputAtOnceOrNotAtAll) {
  const std::string input = write("ball.json", sphereText());
  write("out.ambient", "something older");
  const std::string open = write("open.obj", objText(withoutTriangle(unitTetrahedron(), 0)));
  EXPECT_NE(buildRefusal(open, {"--strict"}), "");
  EXPECT_EQ(bytesOfFile("out.ambient"), "something older");
  resultOf({"build", input, "-o", path("out.ambient"), "--json"});
  EXPECT_EQ(readFluidBody(path("out.ambient")).name, "ball");
  EXPECT_EQ(fileCount(), 3u);
}

TEST_F(CommandLine, WhatIsNoFluidBodyIsNotReplaced) {
  const std::string input = write("ball.json", sphereText());
  const std::string mesh = objText(unitTetrahedron());
  const std::string other = write("other.obj", mesh);
  EXPECT_EQ(refusal({"build", input, "-o", other}),
            other +
                ": not a .ambient file: it does not begin with the mark of one, and is not "
                "replaced");
  EXPECT_EQ(bytesOfFile("other.obj"), mesh);
  write("ball.body", "");
  for (const char* const scale : {"1", "2"})  // an empty file, then another name
    resultOf({"build", input, "-o", path("ball.body"), "--json", "--scale", scale});
}

TEST_F(CommandLine, SymbolicLinksAreWrittenThrough) {
  const std::string input = write("ball.json", sphereText());
  fs::create_directory(path("inner"));
  fs::create_symlink("inner/first", path("out.ambient"));
  fs::create_symlink(path("inner/ball.ambient"), path("inner/first"));
  for (const char* const scale : {"1", "2"}) {  // missing target, then existing target
    const Arguments build{"build", input, "-o", path("out.ambient"), "--json", "--scale", scale};
    const double volume = resultOf(build)["volume"].get<double>();
    EXPECT_TRUE(fs::is_symlink(path("out.ambient")) && fs::is_symlink(path("inner/first")));
    EXPECT_FALSE(fs::is_symlink(path("inner/ball.ambient")));
    EXPECT_EQ(readFluidBody(path("inner/ball.ambient")).volume, volume);
  }
  fs::create_symlink("nowhere/ball.ambient", path("lost.ambient"));
  EXPECT_EQ(refusal({"build", input, "-o", path("lost.ambient")}),
            path("lost.ambient") + ": the directory \"" + path("nowhere") + "\" does not exist");
}

TEST_F(CommandLine, NamesMayBeAsLongAsTheSystemHasThem) {
  const std::string input = write("ball.json", sphereText());
  const std::string name = std::string(255 - std::string(".ambient").size(), 'x') + ".ambient";
  resultOf({"build", input, "-o", path(name), "--json"});
  EXPECT_EQ(refusal({"build", input, "-o", path("x" + name)}),
            path("x" + name) + ": cannot be written: File name too long");
  EXPECT_EQ(fileCount(), 2u);
}

/// Scope in which files of started programs are limited to a number of bytes.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() { ::setrlimit(RLIMIT_FSIZE, &before_); }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  rlimit before_{};
};

TEST_F(CommandLine, ALimitOfTheFileSizeLeavesNothing) {
  const std::string input = write("ball.json", sphereText());
  const FileSizeLimit limit(1000);
  EXPECT_EQ(buildRefusal(input), path("out.ambient") + ": cannot be written: File too large");
}

TEST_F(CommandLine, EscapesInNamesDoNotReachTheTerminal) {
  const std::string escape = "\033[2J\u009b2J\n";
  const auto outputOf = [](const Arguments& arguments) {
    const ProgramResult result = run(arguments);
    return result.output + result.errors;
  };
  const std::string mesh = write(escape + ".obj", objText(insideOut(unitTetrahedron())));
  const std::string ambient = path(escape + ".ambient");
  for (const Arguments& arguments :
       {Arguments{"build", mesh, "-o", ambient, "--panels", "100"},
        Arguments{"build", mesh, "-o", ambient, "--panels", "100"},  // keeps the file
        Arguments{"inspect", ambient}, Arguments{"check", mesh, "--estimate", "--panels", "100"},
        Arguments{"inspect", path(escape)}, Arguments{escape}, Arguments{"inspect", "--" + escape},
        Arguments{"build", path(escape + ".bullet"), "-o", path("folder")}}) {
    const std::string output = outputOf(arguments);
    EXPECT_NE(output, "");
    EXPECT_EQ(output.find_first_of("\033\302"), std::string::npos) << output;
  }
}

using nlohmann::json;

TEST_F(CommandLine, BadMeshesAreRefusedInOneLineThatNamesTheFile) {
  const TriangleMesh tetrahedron = unitTetrahedron();
  const std::string missing = path("no such.obj");
  EXPECT_EQ(buildRefusal(missing), missing + ": no such file");
  const std::string open = write("open.obj", objText(withoutTriangle(tetrahedron, 3)));
  EXPECT_EQ(buildRefusal(open, {"--strict"})
                .find(open + ": not watertight: 3 boundary edges, for example from vertex "),
            0u);
  const std::string closed = write("closed.obj", objText(tetrahedron));
  EXPECT_NE(buildRefusal(closed, {"--sheet"}).find("is closed: a sheet needs a boundary"),
            std::string::npos);
}

TEST_F(CommandLine, MeshesOfNothingAreRefusedStrictOrNot) {
  const TriangleMesh sheet = makeRectangularSheetMesh(1, 1, 50);
  std::string nan = objText(unitTetrahedron());
  nan.replace(nan.find("v 1 0 0"), 7, "v 1 nan 0");
  for (const std::string& file : {write("empty.obj", ""), write("points.obj", "v 0 0 0\nv 1 0 0\n"),
                                  write("nan.obj", nan), write("sheet.obj", objText(sheet))}) {
    EXPECT_EQ(buildRefusal(file).find(file + ": "), 0u);
    EXPECT_EQ(buildRefusal(file, {"--strict"}).find(file + ": "), 0u);
  }
}

TEST_F(CommandLine, BrokenMeshesAreBuiltWithOneLineUnlessStrict) {
  const TriangleMesh box = makeBoxMesh({1, 1, 1}, 12);
  TriangleMesh open = box;
  for (Eigen::Index t = open.triangleCount() - 1; t >= 0; --t)
    if (open.barycentre(t).z() > 1 - 1e-9) open = withoutTriangle(open, t);
  const TriangleMesh holed = withoutTriangle(box, 5);
  const std::vector<std::pair<TriangleMesh, double>> cases{
      {open, 8}, {holed, 8}, {joined(moved(box, {1.3, 0.4, 0.3}), holed), 16 - 0.7 * 1.6 * 1.7}};
  for (const auto& [mesh, volume] : cases) {
    const std::string input = write("mesh.obj", objText(mesh));
    const std::string strictly = buildRefusal(input, {"--strict"});
    EXPECT_EQ(strictly.find(input + ": not watertight: "), 0u) << strictly;
    const ProgramResult built =
        run({"build", input, "-o", path("out.ambient"), "--panels", "0", "--json"});
    EXPECT_EQ(built.exit_code, 0) << built.errors;
    EXPECT_EQ(built.errors.find("; wrapped with"), built.errors.rfind("; wrapped with"))
        << built.errors;
    EXPECT_EQ(volume > 8, built.errors.find("is not resolved") != std::string::npos);
    EXPECT_EQ(built.errors.find("warning: " + input + ": not watertight: "), 0u) << built.errors;
    EXPECT_NEAR(json::parse(built.output)["volume"].get<double>(), volume, 0.02 * volume);
    EXPECT_EQ(readFluidBody(path("out.ambient")).name, "mesh");
    EXPECT_NE(refusal({"build", input, "-o", path("out.ambient"), "--strict"}), "")
        << "the file of a laxer build is no answer";
    std::filesystem::remove(path("out.ambient"));
  }
}

TEST_F(CommandLine, BadShapesAreRefusedInOneLineThatNamesTheFile) {
  const std::string negative = write("negative.json", R"({"type":"sphere","radius":-1})");
  EXPECT_EQ(buildRefusal(negative), negative + ": radius is -1; must be > 0");
  const std::string lost = write("lost.json", R"({"type":"mesh","file":"lost.obj"})");
  EXPECT_EQ(buildRefusal(lost), path("lost.obj") + ": no such file");
  const std::string built = write("built.json", R"({"type":"fluid_body","file":"x.ambient"})");
  EXPECT_EQ(buildRefusal(built), built + ": a shape \"fluid_body\" is built already");
  const std::string ball = write("ball.json", sphereText());
  EXPECT_EQ(buildRefusal(ball, {"--sheet"}), ball + ": --sheet needs a shape of type \"sheet\"");
}

TEST_F(CommandLine, ShapesBeyondWhatCanBeSolvedAreRefused) {
  expectRefusals(AMBIENT_COMMAND_REFUSALS, "shapes", [&](const json& shape) {
    const std::string file = write("shape.json", shape.dump()),
                      message = buildRefusal(file, {"--panels", "0"});
    EXPECT_EQ(message.find(file + ": "), 0u) << message;
    return message.substr(std::min(message.size(), file.size() + 2));
  });
}

TEST_F(CommandLine, BadValuesOfOptionsAreRefusedByName) {
  const std::string ball = write("ball.json", sphereText());
  const std::string box = write("box.obj", objText(makeBoxMesh({1, 1, 1}, 12)));
  expectUsageRefusals("options of build", {"build", ball, "-o", path("out.ambient")});
  expectUsageRefusals("options of build with a mesh", {"build", box, "-o", path("out.ambient")});
}

TEST_F(CommandLine, OriginsFarFromTheBodyAreRefused) {
  const std::string box = write("box.json", R"({"type":"box","half_sizes":[1,2,2],"faces":48})");
  EXPECT_EQ(buildRefusal(box, {"--origin", "1e308,0,0"}),
            box +
                ": the body reaches 1e+308 m from its origin, more than 1000000 times its size of "
                "6 m");
  EXPECT_EQ(buildRefusal(box, {"--origin", "0,0,7e6"}).find(box + ": the body reaches 7000002 m"),
            0u);
}

TEST_F(CommandLine, PlacesThatCannotBeWrittenAreRefused) {
  const std::string ball = write("ball.json", sphereText());
  const std::string nowhere = path("no folder/out.ambient");
  EXPECT_EQ(refusal({"build", ball, "-o", nowhere}),
            nowhere + ": the directory \"" + path("no folder") + "\" does not exist");
  EXPECT_EQ(refusal({"build", ball, "-o", ball}), ball + ": the output would replace the input");
  EXPECT_EQ(bytesOfFile("ball.json"), sphereText());
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

TriangleMesh box() { return makeBoxMesh({1, 1, 1}, 12); }

/// A box without its lid, and a sheet inside.
TriangleMesh openBox() { return withoutTriangle(withoutTriangle(box(), 11), 10); }

TEST_F(CommandLine, CheckSaysThatAMeshIsRight) {
  const ProgramResult result = run({"check", write("box.obj", objText(box()))});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_EQ(result.output,
            "usable            yes\nfaces             12\nsize              2, 2, 2 m\n"
            "volume            8 m^3\nwrapped           no\n");
}

TEST_F(CommandLine, CheckFindsAllDefectsAndWhatMendsThem) {
  TriangleMesh mesh = joined(openBox(), openBox());
  mesh = joined(mesh, moved(box(), {0.4, 0.55, 0.7}));
  const std::string input = write("open.obj", objText(mesh));
  const ProgramResult result =
      run({"check", input, "--strict", "--json", "--obj", path("bad.obj")});
  EXPECT_EQ(result.exit_code, 1);
  const json found = json::parse(result.output);
  EXPECT_EQ(found["usable"], false);
  std::vector<std::string> kinds;
  for (const json& defect : found["defects"]) kinds.push_back(defect["kind"]);
  EXPECT_NE(std::find(kinds.begin(), kinds.end(), "doubled triangles"), kinds.end());
  EXPECT_NE(std::find(kinds.begin(), kinds.end(), "parts overlap"), kinds.end());
  EXPECT_GE(kinds.size(), 3u);
  for (const json& remedy : found["remedies"]) {
    EXPECT_EQ(remedy["usable"], remedy["option"] != "--sheet") << remedy;
  }
  const std::string obj = readText(path("bad.obj"));
  EXPECT_NE(obj.find("o doubled_triangles\nv "), std::string::npos);
  EXPECT_NE(obj.find("\nf 1 2 3\n"), std::string::npos);
}

TEST_F(CommandLine, CheckSaysWhatBuildWouldDo) {
  const std::string open = write("open.obj", objText(openBox()));
  const ProgramResult wrapped = run({"check", open});
  EXPECT_EQ(wrapped.exit_code, 0) << wrapped.errors;
  EXPECT_NE(wrapped.output.find("\n  text            not watertight: 4 boundary edges"),
            std::string::npos)
      << wrapped.output;
  EXPECT_NE(wrapped.output.find("\nfaces             800\n"), std::string::npos);
  EXPECT_NE(wrapped.output.find("\nwrapped           yes\n"), std::string::npos);
  EXPECT_EQ(wrapped.errors.find("warning: " + open + ": not watertight: "), 0u) << wrapped.errors;
  EXPECT_EQ(resultOf({"check", write("box.obj", objText(box())), "--json"})["wrapped"], false);
  const std::string sheet = write("sheet.obj", objText(makeRectangularSheetMesh(1, 1, 50)));
  const ProgramResult refused = run({"check", sheet});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_NE(refused.output.find("\n  option          --sheet\n  usable          yes\n"),
            std::string::npos)
      << refused.output;
  EXPECT_EQ(usageRefusal({"build", open, "-o", path("x.ambient"), "--wrap", "--strict"}),
            "--wrap: excludes --strict");
}

TEST_F(CommandLine, RefusalsMentionWrapWhichMendsThem) {
  const std::string input = write("open.obj", objText(openBox()));
  EXPECT_NE(
      buildRefusal(input, {"--strict"}).find("(build --wrap makes a closed surface around it)"),
      std::string::npos);
  const ProgramResult wrapped =
      run({"build", input, "-o", path("w.ambient"), "--wrap", "0.1", "--panels", "0", "--json"});
  EXPECT_EQ(wrapped.exit_code, 0) << wrapped.errors;
  EXPECT_NE(wrapped.errors.find("wrapped with a size of 0.1 m"), std::string::npos);
  EXPECT_GE(json::parse(wrapped.output)["faces"], 800);
}

TEST_F(CommandLine, HullAndWrapAreBuiltAnewWhenTheyChange) {
  const std::string input = write("l.obj", objText(joined(box(), moved(box(), {3, 0, 0}))));
  const auto volumeOf = [&](const Arguments& more) {
    const Arguments build{"build", input, "-o", path("o.ambient"), "--panels", "0", "--json"};
    return json::parse(run(appended(build, more)).output)["volume"].get<double>();
  };
  EXPECT_NEAR(volumeOf({}), 16, 1e-9);
  EXPECT_NEAR(volumeOf({"--hull"}), 20, 1e-6);
  EXPECT_NEAR(volumeOf({"--wrap=0.1"}), 16, 0.05);
  EXPECT_NEAR(volumeOf({"--scale", "2", "--wrap", "0.2"}), 128, 0.4);
}

TEST_F(CommandLine, BadSizesAndCombinationsLeaveNothing) {
  const std::string input = write("box.obj", objText(box()));
  EXPECT_NE(buildRefusal(input, {"--wrap", "1e-6"}).find("give a larger size"), std::string::npos);
  EXPECT_EQ(usageRefusal({"check", input, "--obj", path("bad.txt")}),
            "--obj: \"" + path("bad.txt") + "\" does not end in .obj");
  EXPECT_NE(refusal({"check", path("none.obj")}).find("no such file"), std::string::npos);
  const std::string ball = write("ball.json", sphereText());
  EXPECT_NE(buildRefusal(ball, {"--hull"}).find("--hull needs a mesh"), std::string::npos);
}

}  // namespace
}  // namespace ambient
