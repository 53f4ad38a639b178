// Output files: places, links, names, and existing files there.

#include "tests/preprocess/command_line/command_line.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

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

}  // namespace
}  // namespace ambient
