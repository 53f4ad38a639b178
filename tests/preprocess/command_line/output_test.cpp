// Output files: places, links, names, and existing files there.
#include <sys/resource.h>

#include "bullet_ambient/fluid_body/file/fluid_body_file.h"
#include "tests/preprocess/command_line/command_line.h"
#include "tests/preprocess/mesh/mesh_fixtures.h"

namespace ambient {
namespace {

namespace fs = std::filesystem;

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
