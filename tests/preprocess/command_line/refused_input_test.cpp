#include <gtest/gtest.h>

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
  const std::string open = write("open.obj", objText(withoutTriangle(tetrahedron, 3)));
  EXPECT_EQ(buildRefusal(open).find(open + ": not watertight: 3 boundary edges, for example from "
                                           "vertex "),
            0u);
  const std::string closed = write("closed.obj", objText(tetrahedron));
  EXPECT_NE(buildRefusal(closed, {"--sheet"}).find("is closed: a sheet needs a boundary"),
            std::string::npos);
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

}  // namespace
}  // namespace ambient
