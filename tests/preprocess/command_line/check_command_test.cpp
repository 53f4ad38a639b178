#include "preprocess/mesh/shapes/primitives.h"
#include "tests/preprocess/command_line/command_line.h"
#include "tests/preprocess/mesh/mesh_fixtures.h"

namespace ambient {
namespace {

using nlohmann::json;

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
