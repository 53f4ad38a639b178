#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "bullet_ambient/fluid_body/file/fluid_body_file.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "tests/preprocess/command_line/command_line.h"
#include "tests/preprocess/mesh/mesh_fixtures.h"

namespace ambient {
namespace {

using nlohmann::json;

TEST_F(CommandLine, BadMeshesAreRefusedInOneLineThatNamesTheFile) {
  const TriangleMesh tetrahedron = unitTetrahedron();
  const std::string missing = path("no such.obj");
  EXPECT_EQ(buildRefusal(missing), missing + ": no such file");
  const std::string foreign = write("notes.txt", "these are notes");
  EXPECT_EQ(buildRefusal(foreign).find(foreign + ": cannot be read as a mesh: "), 0u);
  const std::string open = write("open.obj", objText(withoutTriangle(tetrahedron, 3)));
  EXPECT_EQ(buildRefusal(open, {"--strict"})
                .find(open + ": not watertight: 3 boundary edges, for example from vertex "),
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
    EXPECT_EQ(std::count(built.errors.begin(), built.errors.end(), '\n'), 1) << built.errors;
    EXPECT_EQ(built.errors.find("warning: " + input + ": not watertight: "), 0u) << built.errors;
    EXPECT_NEAR(json::parse(built.output)["volume"].get<double>(), volume, 0.02 * volume);
    EXPECT_EQ(readFluidBody(path("out.ambient")).name, "mesh");
    EXPECT_NE(refusal({"build", input, "-o", path("out.ambient"), "--strict"}), "")
        << "the file of a laxer build is no answer";
    std::filesystem::remove(path("out.ambient"));
  }
}

TEST_F(CommandLine, BadShapesAreRefusedInOneLineThatNamesTheFile) {
  const std::string typo = write("typo.json", R"({"type":"sphere","radios":1})");
  EXPECT_EQ(buildRefusal(typo).find(typo + ": "), 0u);
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
  const auto refusalOf = [&](const std::string& shape) {
    const std::string file = write("shape.json", shape),
                      message = buildRefusal(file, {"--panels", "0"});
    EXPECT_EQ(message.find(file + ": "), 0u) << message;
    return message.substr(std::min(message.size(), file.size() + 2));
  };
  const std::string sizes = " m; each must be 1e-09 m to 1e+09 m",
                    slender = " m; the longest must be at most 1000000 times the shortest";
  EXPECT_EQ(refusalOf(R"({"type":"sphere","radius":1e300})"),
            "its half extents are 1e+300 x 1e+300 x 1e+300" + sizes);
  EXPECT_EQ(refusalOf(R"({"type":"sphere","radius":1e-300})"),
            "its half extents are 1e-300 x 1e-300 x 1e-300" + sizes);
  EXPECT_EQ(refusalOf(R"({"type":"box","size":[2,2e-9,2e-9]})"),
            "its half extents are 1 x 1e-09 x 1e-09" + slender);
  EXPECT_EQ(refusalOf(R"({"type":"sheet","size":[1e-200,2],"faces":50})"),
            "its half extents are 5e-201 x 1" + slender);
  EXPECT_EQ(refusalOf(R"({"type":"box","half_sizes":[1,1,2e-6],"faces":48})")
                .find("it is too thin: its volume over its area^1.5 is "),
            0u);
  EXPECT_EQ(refusalOf("{\"type\":\"sphere\",\"radius\":1,\"a\\nb\":2}")
                .find("unknown key \"a\\nb\" in the shape"),
            0u);
}

TEST_F(CommandLine, BadValuesOfOptionsAreRefusedByName) {
  const std::string ball = write("ball.json", sphereText());
  const auto refused = [&](const char* option, const char* value) {
    const std::string message = buildUsageRefusal(ball, {option, value});
    const std::string beginning = std::string(option) + ": ";
    EXPECT_EQ(message.find(beginning), 0u) << message;
    return message.substr(std::min(message.size(), beginning.size()));
  };
  for (const char* scale : {"0", "-1", "nan", "inf"})
    EXPECT_EQ(refused("--scale", scale), std::string(scale) + " must be finite and positive");
  EXPECT_EQ(refused("--scale", "1e400"), "inf must be finite and positive");
  EXPECT_EQ(refused("--threads", "-1"), "-1 is below 0 (0: all cores)");
  EXPECT_EQ(refused("--threads", "1000"), "1000 is above 256");
  for (const char* option : {"--panels", "--least-faces"}) {
    EXPECT_EQ(refused(option, "2000000"), "2000000 is above 1000000");
    EXPECT_EQ(refused(option, "-1"), "-1 is below 0 (0: no division)");
  }
  EXPECT_EQ(refused("--levels", "15"), "15 faces are not 16 to 1024");
  for (const char* option : {"--waterline-table=17", "--waterline-table=0"})
    EXPECT_EQ(buildUsageRefusal(ball, {option}),
              "--waterline-table: its N is not between 1 and 16");
  for (const char* origin : {"1,2", "1,2,3,4", "a,b,c", "1,2,inf", "centre", "1,2,3x", "nan,0,0"}) {
    EXPECT_EQ(refused("--origin", origin), "\"" + std::string(origin) +
                                               "\" is neither centre-of-volume nor three finite "
                                               "numbers X,Y,Z");
  }
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

}  // namespace
}  // namespace ambient
