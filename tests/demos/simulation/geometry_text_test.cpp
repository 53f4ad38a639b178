#include <gtest/gtest.h>

#include "demos/simulation/output/run_files.h"
#include "tests/demos/scene/scene_text.h"
#include "tests/demos/simulation/scenes/run_scene.h"

namespace ambient {
namespace {

using nlohmann::json;

/// A coarse ball on a hinge above a floor; centre of mass off the centre.
json hungBall() {
  json scene = ballScene();
  scene["bodies"][0]["shape"]["faces"] = 80;
  scene["bodies"][0]["centre_of_mass"] = {0.001, 0, -0.002};
  const json floor_shape = {{"type", "box"}, {"half_sizes", {2, 1, 0.5}}};
  scene["bodies"].push_back(
      {{"name", "floor"}, {"shape", floor_shape}, {"mass", 0}, {"position", {0, 0, -3}}});
  scene["joints"] = {{{"bodies", {"ball"}}, {"point", {0, 0, 1.5}}, {"axis", {0, 1, 0}}}};
  scene["medium"]["velocity"] = {0.1, 0, 0};
  return scene;
}

json geometryOf(const json& text) {
  const Scene scene = sceneFrom(text);
  return json::parse(makeGeometryText(scene, prepare(scene)));
}

/// Bounding box of a body's vertices.
struct Box {
  Vector3 low = Vector3::Constant(1e300), high = Vector3::Constant(-1e300);
};

Box boxOf(const json& body) {
  Box box;
  const auto numbers = body["vertices"].get<std::vector<double>>();
  for (std::size_t i = 0; i + 2 < numbers.size(); i += 3) {
    const Vector3 vertex(numbers[i], numbers[i + 1], numbers[i + 2]);
    box.low = box.low.cwiseMin(vertex);
    box.high = box.high.cwiseMax(vertex);
  }
  return box;
}

TEST(GeometryText, PlacesVerticesAboutTheCentreOfMass) {
  const json ball = geometryOf(hungBall())["bodies"][0];
  EXPECT_EQ(ball["name"], "ball");
  EXPECT_EQ(ball["triangles"].size(), 3u * 80);
  const Box box = boxOf(ball);
  const Vector3 centre = 0.5 * (box.low + box.high);
  // Float has seven digits for lengths of some centimetres.
  EXPECT_LT((centre - Vector3(-0.001, 0, 0.002)).norm(), 1e-8);
}

TEST(GeometryText, TellsSheets) {
  json scene = ballScene();
  scene["bodies"][0]["shape"] = {{"type", "sheet"}, {"semi_axes", {0.1, 0.1}}, {"faces", 60}};
  const json sheet = geometryOf(scene)["bodies"][0];
  EXPECT_EQ(sheet["sheet"], true);
  EXPECT_EQ(boxOf(sheet).low.z(), boxOf(sheet).high.z());
}

TEST(GeometryText, HasStaticBodiesJointsAndTheFlow) {
  const json geometry = geometryOf(hungBall());
  const json& floor = geometry["bodies"][1];
  EXPECT_EQ(floor["mass"], 0);
  EXPECT_EQ(floor["sheet"], false);
  const Box box = boxOf(floor);
  EXPECT_EQ(box.low, Vector3(-2, -1, -0.5));
  EXPECT_EQ(box.high, Vector3(2, 1, 0.5));
  ASSERT_EQ(geometry["joints"].size(), 1u);
  EXPECT_EQ(geometry["joints"][0]["bodies"], json({"ball"}));
  EXPECT_EQ(geometry["joints"][0]["point"], json({0, 0, 1.5}));
  EXPECT_EQ(geometry["joints"][0]["axis"], json({0, 1, 0}));
  EXPECT_FLOAT_EQ(geometry["medium_velocity"][0].get<float>(), 0.1f);
}

TEST(GeometryText, HasTheWaterWithItsWaves) {
  json scene = hungBall();
  EXPECT_TRUE(geometryOf(scene)["water"].is_null());
  scene["water"] = json::parse(R"({"level": 0.5,
    "waves": [{"amplitude": 0.1, "period": 2, "direction": [0, 3, 1], "phase": 0.25}],
    "bounds": {"lowest": [-1, -2, null], "highest": [1, 2, null]}})");
  const json water = geometryOf(scene)["water"];
  EXPECT_EQ(water["level"], 0.5);
  EXPECT_EQ(water["bounds"]["lowest"], json({-1, -2, nullptr}));
  const json& wave = water["waves"][0];
  EXPECT_EQ(wave["direction"], json({0, 1, 0}));
  EXPECT_EQ(wave["phase"], 0.25);
  EXPECT_NEAR(wave["frequency"].get<double>(), 3.14159265, 1e-6);
  EXPECT_NEAR(wave["wave_number"].get<double>(), 3.14159265 * 3.14159265 / 9.81, 1e-6);
}

}  // namespace
}  // namespace ambient
