#include "demos/gltf/gltf_text.h"

#include <gtest/gtest.h>

#include "tests/demos/scene/scene_text.h"
#include "tests/demos/simulation/scenes/run_scene.h"

namespace ambient {
namespace {

using nlohmann::json;

/// Run of a coarse ball above a floor; a mass of 0 makes the ball static.
struct BallRun {
  Scene scene;
  std::vector<PreparedBody> bodies;
  RunRecord record;

  explicit BallRun(const Vector3& gravity = {0, 0, -9.81}, double mass = 0.43) {
    json text = ballScene();
    text["duration"] = 0.1;
    text["gravity"] = {gravity.x(), gravity.y(), gravity.z()};
    text["bodies"][0]["shape"]["faces"] = 80;
    text["bodies"][0]["mass"] = mass;
    if (mass == 0)
      for (const char* velocity : {"linear_velocity", "angular_velocity"})
        text["bodies"][0].erase(velocity);
    const json floor_shape = {{"type", "box"}, {"half_sizes", {2, 1, 0.5}}};
    text["bodies"].push_back(
        {{"name", "floor"}, {"shape", floor_shape}, {"mass", 0}, {"position", {0, 0, -3}}});
    const TemporaryFolder folder;
    scene = readScene(writeScene(folder, text.dump()));
    bodies = prepare(scene);
    record = runPrepared(scene, bodies);
  }

  std::string write(const std::string& file) const {
    return makeGltf(file, scene, bodies, record.motion);
  }
};

std::uint32_t numberAt(const std::string& bytes, std::size_t at) {
  std::uint32_t number = 0;
  for (std::size_t k = 4; k-- > 0;)
    number = number << 8 | static_cast<unsigned char>(bytes.at(at + k));
  return number;
}

TEST(GltfText, KnowsItsNames) {
  EXPECT_TRUE(isGltfName("a/b.glb"));
  EXPECT_TRUE(isGltfName("b.gltf"));
  EXPECT_FALSE(isGltfName("b.glb.obj"));
  EXPECT_FALSE(isGltfName("glb"));
}

TEST(GltfText, HasOneNodePerBodyAndMovesThoseWithMass) {
  const BallRun run;
  const json text = json::parse(run.write("ball.gltf"));
  const json& root = text["nodes"][text["scenes"][0]["nodes"][0].get<std::size_t>()];
  ASSERT_EQ(root["children"].size(), 2u);
  const json& ball = text["nodes"][root["children"][0].get<std::size_t>()];
  const json& floor = text["nodes"][root["children"][1].get<std::size_t>()];
  EXPECT_EQ(ball["name"], "ball");
  EXPECT_EQ(floor["name"], "floor");
  EXPECT_EQ(floor["translation"], json({0.0, 0.0, -3.0}));
  ASSERT_EQ(text["animations"].size(), 1u);
  const json& channels = text["animations"][0]["channels"];
  ASSERT_EQ(channels.size(), 2u);
  for (const json& channel : channels) EXPECT_EQ(channel["target"]["node"], root["children"][0]);
  EXPECT_EQ(text["buffers"][0]["uri"].get<std::string>().rfind("data:", 0), 0u);
}

TEST(GltfText, TurnsUpIntoY) {
  for (const Vector3& gravity : {Vector3(0, 0, -9.81), Vector3(0, -3, 0), Vector3(1, 2, 3)}) {
    const BallRun run(gravity, 0);
    const json text = json::parse(run.write("ball.gltf"));
    const auto q = text["nodes"][0]["rotation"].get<std::vector<double>>();
    const Vector3 up = Quaternion(q[3], q[0], q[1], q[2]) * (-gravity.normalized());
    EXPECT_LT((up - Vector3::UnitY()).norm(), 1e-14);
  }
}

TEST(GltfText, OfBodiesThatAllStandHasNoAnimation) {
  const BallRun run({0, 0, -9.81}, 0);
  EXPECT_FALSE(json::parse(run.write("ball.gltf")).contains("animations"));
}

TEST(GltfText, ContainerHoldsTheSame) {
  const BallRun run;
  const std::string bytes = run.write("ball.glb");
  EXPECT_EQ(bytes.substr(0, 4), "glTF");
  EXPECT_EQ(numberAt(bytes, 4), 2u);
  EXPECT_EQ(numberAt(bytes, 8), bytes.size());
  const std::uint32_t length = numberAt(bytes, 12);
  EXPECT_EQ(length % 4, 0u);
  json inside = json::parse(bytes.substr(20, length));
  json outside = json::parse(run.write("ball.gltf"));
  outside["buffers"][0].erase("uri");
  EXPECT_EQ(inside, outside);
  const std::uint32_t buffer = numberAt(bytes, 20 + length);
  EXPECT_EQ(inside["buffers"][0]["byteLength"], buffer);
  EXPECT_EQ(20 + length + 8 + buffer, bytes.size());
}

}  // namespace
}  // namespace ambient
