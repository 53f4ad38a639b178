#include <gtest/gtest.h>

#include "demos/simulation/scene_body_cache.h"
#include "demos/simulation/simulation.h"
#include "preprocess/base/fluid_body_writer.h"
#include "preprocess/shape/shape_reader.h"
#include "tests/demos/scene/scene_text.h"
#include "tests/demos/simulation/scenes/run_scene.h"
#include "tests/support/refusal_of.h"

namespace ambient {
namespace {

using nlohmann::json;

/// A ball at rest without gravity.
json stillBall() {
  json scene = ballScene();
  scene["gravity"] = {0, 0, 0};
  scene["bodies"][0]["shape"]["faces"] = 80;
  for (const char* key : {"linear_velocity", "angular_velocity"}) scene["bodies"][0].erase(key);
  return scene;
}

TEST(SimulationForces, ActForOneStepAtTheirPoint) {
  json text = stillBall();
  text["model"] = "vacuum";
  text["bodies"][0]["inertia"] = {0.2, 0.3, 0.4, 0, 0, 0};
  const Scene scene = sceneFrom(text);
  Simulation simulation(scene, prepare(scene));
  simulation.applyForce(0, Vector3(1, 0, 0), Vector3(0, 0.3, 1));  // the ball is at 0, 0, 1
  simulation.applyTorque(0, Vector3(0.2, 0, 0));
  for (int i = 0; i < 3; ++i) simulation.step();
  // F h / m, and (r x F) h / I; spin turns by less than 1e-4 in three steps.
  const Twist twist = simulation.sample()[0].twist;
  EXPECT_NEAR((twist.linear - Vector3(0.01 / 0.43, 0, 0)).norm(), 0, 1e-15);
  EXPECT_NEAR((twist.angular - Vector3(0.01, 0, -0.0075)).norm(), 0, 1e-5);
}

TEST(SimulationJoints, OfNoBodyAndFarFromTheirBodyAreRefused) {
  Scene scene = sceneFrom(stillBall());
  const auto refusal = [&scene](const JointDef& joint) {
    scene.joints = {joint};
    return test::refusalOf<std::exception>([&] { Simulation(scene, prepare(scene)); });
  };
  EXPECT_NE(refusal({{"nobody"}, Vector3(0, 0, 1), std::nullopt})
                .find("there is no rigid body \"nobody\""),
            std::string::npos);
  EXPECT_NE(refusal({{"ball"}, Vector3(0, 1e30, 0), std::nullopt})
                .find("joint of body \"ball\": its point is 1e+30 m from"),
            std::string::npos);
}

/// Boxes that fall into a pile in water, with friction, as compounds of one part.
json fallingBoxes() {
  json scene = stillBall();
  scene["gravity"] = {0, 0, -9.81};
  scene["time_step"] = 1.0 / 240;
  const json floor = {{"name", "floor"},
                      {"shape", {{"type", "box"}, {"size", {2, 2, 0.2}}}},
                      {"mass", 0},
                      {"position", {0, 0, -0.1}}};
  scene["bodies"] = json::array({floor});
  for (int i = 0; i < 6; ++i) {
    const double across = 0.06 * (i % 3) + 0.02 * (i / 3);
    scene["bodies"].push_back({{"name", "box" + std::to_string(i)},
                               {"shape", {{"type", "box"}, {"size", {0.1, 0.1, 0.1}}}},
                               {"mass", 2.5},
                               {"position", {across, 0.01 * i, 0.06 + 0.11 * i}}});
  }
  return scene;
}

// A plate that is pushed, compounds that touch, and a hundred boxes that fall into a pool.
TEST(SimulationState, GoesOnBitForBit) {
  expectSavedStatesGoOn(readNamedScene("plate_9cm"));
  expectSavedStatesGoOn(sceneFrom(fallingBoxes()), 12);
  expectSavedStatesGoOn(readNamedScene("pool"), 5, 0.25);
}

TEST(SimulationRegions, AreReplacedByThoseOfAnotherScene) {
  json text = stillBall();
  text["gravity"] = {0, 0, -9.81};
  text["water"] = {{"level", 0}};
  const Scene scene = sceneFrom(text);
  Simulation simulation(scene, prepare(scene));
  simulation.step();
  EXPECT_EQ(simulation.wet(0).volume, 0);  // the ball is at a height of 1 m
  text["water"]["level"] = 10;
  simulation.setRegions(sceneFrom(text));
  simulation.step();
  EXPECT_EQ(simulation.wet(0).share, 1);
  text.erase("water");
  EXPECT_THROW(simulation.setRegions(sceneFrom(text)), std::runtime_error);
}

TEST(SimulationRobots, MayBeTheOnlyBodies) {
  json text = stillBall();
  text["bodies"] = json::array();
  const Scene scene = sceneFrom(text);
  EXPECT_THROW(Simulation(scene, {}), std::runtime_error);
  Simulation simulation(scene, {}, true);
  simulation.step();
  EXPECT_TRUE(simulation.sample().empty());
}

TEST(SimulationState, OfAnotherSceneIsRefused) {
  const Scene one = sceneFrom(stillBall()), plate = readNamedScene("plate_9cm");
  Simulation simulation(one, prepare(one));
  const std::string state = simulation.saveState();
  EXPECT_THROW(simulation.restoreState(""), std::runtime_error);
  EXPECT_THROW(simulation.restoreState(state.substr(0, state.size() - 1)), std::runtime_error);
  EXPECT_THROW(simulation.restoreState(Simulation(plate, prepare(plate)).saveState()),
               std::runtime_error);
}

ShapeDescription ball(double radius) {
  return readShape({{"type", "sphere"}, {"radius", radius}, {"faces", 80}}, "", "ball");
}

TEST(SceneBodyCache, SolvesAShapeOnce) {
  SceneBodyCache cache;
  const auto first = cache.get(ball(1), "a");
  EXPECT_EQ(cache.get(ball(1), "b"), first);
  EXPECT_NE(cache.get(ball(2), "c"), first);
}

TEST(SceneBodyCache, ABodyWithAWaterlineTableIsAnotherOne) {
  const ShapeDescription box =
      readShape({{"type", "box"}, {"size", {1, 1, 1}}, {"faces", 48}}, "", "box");
  SceneBodyCache cache;
  const auto plain = cache.get(box, "a"), with = cache.get(box, "a", 1);
  EXPECT_TRUE(plain->waterline.empty());
  EXPECT_EQ(with->waterline.subdivisions, 1);
  EXPECT_EQ(cache.get(box, "b", 1), with);
}

TEST(SceneBodyCache, WritesNothingBeforeItIsSaved) {
  const TemporaryFolder folder;
  SceneBodyCache cache(folder / "cache");
  cache.get(ball(1), "a");
  EXPECT_TRUE(folder.empty());
}

TEST(SceneBodyCache, ReadsInTheNextRunWhatThisOneSolved) {
  const TemporaryFolder folder;
  SceneBodyCache cache(folder.path());
  const auto solved = cache.get(ball(1), "a");
  EXPECT_EQ(cache.solved(), 1);
  cache.save();
  SceneBodyCache next(folder.path());
  const auto read = next.get(ball(1), "a");
  EXPECT_EQ(next.solved(), 0);
  EXPECT_EQ(encodeFluidBody(*read, ""), encodeFluidBody(*solved, ""));
  next.get(ball(2), "a");
  EXPECT_EQ(next.solved(), 1);
}

TEST(SceneBodyCache, SaysOfABodyThatItReadsWhatWasSaidOfIt) {
  const TemporaryFolder folder;
  const ShapeDescription few = readShape(
      {{"type", "ellipsoid"}, {"semi_axes", {1, 1, 0.9}}, {"faces", 80}}, "", "scene.json");
  for (const int made : {1, 0}) {
    std::vector<std::string> lines;
    SceneBodyCache cache(folder.path(), 0, [&](const std::string& text) { lines.push_back(text); });
    cache.get(few, "a");
    EXPECT_EQ(cache.solved(), made);
    ASSERT_EQ(lines.size(), 1u) << made;
    EXPECT_EQ(lines[0].rfind("scene.json: 80 triangles are few", 0), 0u) << lines[0];
    cache.save();
  }
}

}  // namespace
}  // namespace ambient
