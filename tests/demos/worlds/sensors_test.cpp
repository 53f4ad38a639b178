#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "bullet_ambient/force/medium/waves.h"
#include "bullet_ambient/spatial/rotation.h"
#include "demos/worlds/world_batch.h"
#include "tests/demos/scene/scene_text.h"
#include "tests/demos/simulation/scenes/run_scene.h"
#include "tests/demos/worlds/vehicle_scene.h"
#include "tests/support/refusal_of.h"

// Readings of the sensors of worlds, and what varies.
namespace ambient {
namespace {

using nlohmann::json;

constexpr double kGravity = 9.81;

/// A heavy box over a floor, without a fluid.
json boxOnFloor() {
  json scene = ballScene();
  scene["medium"] = {{"density", 0}};
  scene["bodies"] = json::array({{{"name", "floor"},
                                  {"mass", 0},
                                  {"shape", {{"type", "box"}, {"size", {4, 4, 1}}}},
                                  {"position", {0, 0, -0.5}}},
                                 {{"name", "box"},
                                  {"mass", 5},
                                  {"shape", {{"type", "box"}, {"size", {0.4, 0.4, 0.4}}}},
                                  {"position", {0, 0, 0.2}}}});
  return scene;
}

/// Readings of one world after `steps` env steps.
std::vector<double> read(const json& scene, BatchSettings settings, int steps) {
  settings.threads = 1;
  WorldBatch batch(sceneFrom(scene), settings);
  for (int n = 0; n < steps; ++n) batch.step();
  return {batch.observations(), batch.observations() + batch.plan().observation_size};
}

BatchSettings reading(std::vector<ObservationDef> observations) {
  BatchSettings settings;
  settings.observations = std::move(observations);
  return settings;
}

TEST(Sensors, OnAFloorFeelWeightAndContact) {
  const auto seen = read(boxOnFloor(), reading({{"imu"}, {"contact"}, {"wet"}}), 200);
  for (const int k : {0, 1, 2, 3, 4}) EXPECT_NEAR(seen[static_cast<std::size_t>(k)], 0, 0.02) << k;
  EXPECT_NEAR(seen[5], kGravity, 0.02);
  EXPECT_NEAR(seen[6], 5 * kGravity * 0.01, 0.01 * 5 * kGravity * 0.01);
  EXPECT_EQ(seen[7], 0);
}

TEST(Sensors, InFreeFallFeelNothing) {
  json scene = boxOnFloor();
  scene["bodies"][1]["position"] = {0, 0, 50};
  const auto seen = read(scene, reading({{"imu"}, {"depth"}, {"contact"}}), 3);
  EXPECT_NEAR(seen[5], 0, 1e-9);
  EXPECT_EQ(seen[7], 0);
  EXPECT_NEAR(seen[6], -50 + kGravity * 0.01 * 0.01 * 6, 1e-3);
}

// On an arm r at the rate w: w^2 r towards the axis, here besides gravity.
TEST(Sensors, OnAnArmFeelTheTurn) {
  json scene = boxOnFloor();
  scene["gravity"] = {0, 0, 0};
  scene["bodies"][1]["position"] = {0, 0, 50};
  scene["bodies"][1]["angular_velocity"] = {0, 0, 3};
  ObservationDef imu{"imu"}, log{"velocity_log"};
  imu.place = log.place = Vector3(0.5, 0, 0);
  const auto seen = read(scene, reading({imu, log}), 7);
  EXPECT_NEAR(seen[2], 3, 1e-9);
  EXPECT_NEAR(seen[3], -9 * 0.5, 1e-9);
  EXPECT_NEAR(seen[4], 0, 1e-9);
  EXPECT_NEAR(seen[7], 1.5, 1e-9);
}

json ballInSea() {
  json scene = ballScene();
  scene["water"] = {
      {"level", 2}, {"current", {0.4, 0, 0}}, {"waves", {{{"amplitude", 0.3}, {"period", 4}}}}};
  scene["bodies"][0]["mass"] = 5.5;
  scene["bodies"][0]["linear_velocity"] = {1, 0, 0};
  return scene;
}

// Height of a linear wave, a cos(k x - w t), carried along by the current, over the place.
TEST(Sensors, ReadDepthUnderAWave) {
  const auto seen = read(ballInSea(), reading({{"position"}, {"depth"}}), 20);
  const double rate = 2 * std::acos(-1.0) / 4, time = 0.2;
  const double number = rate * rate / kGravity;
  const double level = 2 + 0.3 * std::cos(number * (seen[0] - 0.4 * time) - rate * time);
  EXPECT_NEAR(seen[3], level - seen[2], 2e-3);
}

TEST(Sensors, ReadTheFlowThatAWorldHasDrawn) {
  json scene = ballScene();
  scene["gravity"] = {0, 0, 0};
  scene["bodies"][0]["linear_velocity"] = {0, 0, 0};
  scene["bodies"][0]["angular_velocity"] = {0, 0, 0};
  BatchSettings settings = reading({{"flow"}, {"twist"}, {"parameters"}});
  settings.variations = {{"current", "", {2, -1, 0}, {2, -1, 0}}};
  const auto at_first = read(scene, settings, 0);
  EXPECT_EQ(at_first[0], 2);
  EXPECT_EQ(at_first[1], -1);
  EXPECT_EQ(at_first[9], 2);
  const auto later = read(scene, settings, 3);
  EXPECT_GT(later[6], 0);  // the flow takes the ball along
  EXPECT_NEAR(later[0] + later[6], 2, 1e-12);
}

// The current of a world acts as one that the scene has, bit for bit in what the ball does.
TEST(Variations, ACurrentActsAsThatOfTheScene) {
  json scene = ballScene();
  BatchSettings settings = reading({{"position"}, {"twist"}});
  json carried = scene;
  carried["medium"]["velocity"] = {3, 1, 0};
  const auto expected = read(carried, settings, 50);
  settings.variations = {{"current", "", {3, 1, 0}, {3, 1, 0}}};
  const auto seen = read(scene, settings, 50);
  for (std::size_t k = 0; k < seen.size(); ++k)
    EXPECT_NEAR(seen[k], expected[k], 1e-12 * std::abs(expected[k])) << k;
}

TEST(Variations, OfMassAndPlaceAreThoseOfTheScene) {
  json scene = ballScene();
  scene["bodies"][0]["angular_velocity"] = {0, 0, 0};
  BatchSettings settings = reading({{"position"}, {"twist_world"}});
  settings.variations = {{"mass", "", {1.5}, {1.5}},
                         {"position", "", {1, 2, 3}, {1, 2, 3}},
                         {"twist", "", {0, 0, 0, -10, 0, 0}, {0, 0, 0, -10, 0, 0}},
                         {"loads", "", {0.5}, {0.5}},
                         {"added_mass", "", {2}, {2}}};
  const auto seen = read(scene, settings, 40);
  json other = scene;
  other["bodies"][0]["mass"] = 0.43 * 1.5;
  other["bodies"][0]["position"] = {1, 2, 4};
  other["bodies"][0]["linear_velocity"] = {20, 0, 0};
  other["bodies"][0]["load_factor"] = 0.5;
  other["bodies"][0]["added_mass_factor"] = 2;
  const auto expected = read(other, reading(settings.observations), 40);
  for (std::size_t k = 0; k < seen.size(); ++k)
    EXPECT_NEAR(seen[k], expected[k], 1e-11 * (1 + std::abs(expected[k]))) << k;
}

// A box slides on a floor: Coulomb friction with the product of both coefficients slows it.
TEST(Variations, OfFrictionSlowASlidingBody) {
  json scene = boxOnFloor();
  scene["bodies"][0]["friction"] = 0.5;
  scene["bodies"][1]["friction"] = 0.4;
  scene["bodies"][1]["linear_velocity"] = {1, 0, 0};
  BatchSettings settings = reading({{"twist_world"}});
  const auto speedWith = [&](const char* body, double factor) {
    settings.variations = {{"friction", body, {factor}, {factor}}};
    return read(scene, settings, 20)[3];
  };
  const double slowed = kGravity * 0.2;
  EXPECT_NEAR(speedWith("", 0), 1, 1e-3);
  EXPECT_NEAR(speedWith("", 1), 1 - 0.2 * slowed, 0.01);
  EXPECT_NEAR(speedWith("floor", 2), 1 - 0.4 * slowed, 0.01);
}

/// Compares a centre of mass that varies with one that the scene has.
void expectTheCentreOfTheScene(const json& scene, std::size_t body, int steps, double tolerance) {
  const Vector3 offset(0.05, -0.03, 0.02);
  json drawn = scene, placed = scene;
  for (json* each : {&drawn, &placed})
    (*each)["bodies"][body]["inertia"] = {0.4, 0.7, 0.9, 0.02, 0, 0.01};
  json& there = placed["bodies"][body];
  const Quaternion turned = rotationFromVector({0.3, -0.2, 0.4});
  for (json* each : {&drawn, &placed})
    (*each)["bodies"][body]["orientation"] = {turned.w(), turned.x(), turned.y(), turned.z()};
  drawn["bodies"][body]["centre_of_mass"] = {0, 0, 0};
  there["centre_of_mass"] = {offset.x(), offset.y(), offset.z()};
  const Vector3 place = turned * offset;
  for (std::size_t k = 0; k < 3; ++k)
    there["position"][k] = there["position"][k].get<double>() + place[static_cast<Eigen::Index>(k)];
  ObservationDef log{"velocity_log"};
  log.place = Vector3(0.3, 0.1, 0);
  BatchSettings settings = reading({{"position"}, {"rotation"}, {"twist_world"}, log, {"contact"}});
  settings.observations[3].place -= offset;
  const auto expected = read(placed, settings, steps);
  settings.observations[3].place = log.place;
  settings.variations = {{"centre_of_mass", "", {0.05, -0.03, 0.02}, {0.05, -0.03, 0.02}}};
  const auto seen = read(drawn, settings, steps);
  for (std::size_t k = 0; k < seen.size(); ++k) EXPECT_NEAR(seen[k], expected[k], tolerance) << k;
  settings.variations.clear();
  EXPECT_GT(std::abs(read(drawn, settings, steps)[0] - expected[0]), 1e-3);
}

TEST(Variations, OfTheCentreOfMassIsThatOfTheScene) {
  json pushed = vehicle();
  for (json& thruster : pushed["thrusters"]) thruster["command"] = 0.7;
  expectTheCentreOfTheScene(pushed, 0, 100, 1e-9);
  json falling = boxOnFloor();
  falling["bodies"][1]["position"] = {0, 0, 0.6};
  expectTheCentreOfTheScene(falling, 1, 60, 1e-6);
}

TEST(Variations, OfTheCentreOfMassForgetTheEpisodeBefore) {
  BatchSettings settings = reading({{"position"}, {"twist_world"}, {"contact"}});
  settings.variations = {{"centre_of_mass", "", {-0.1, -0.1, -0.05}, {0.1, 0.1, 0.05}}};
  settings.threads = 1;
  WorldBatch batch(sceneFrom(boxOnFloor()), settings), fresh(sceneFrom(boxOnFloor()), settings);
  const auto seen = [](WorldBatch& of) {
    for (int n = 0; n < 30; ++n) of.step();
    return std::vector<double>(of.observations(), of.observations() + 10);
  };
  const std::vector<double> expected = seen(fresh);
  batch.reset();
  EXPECT_NE(seen(batch), expected);
  const std::uint64_t seed = settings.seed;
  batch.reset(nullptr, &seed);
  EXPECT_EQ(seen(batch), expected);
  fresh.restore(0, batch.state(0));
  EXPECT_EQ(seen(fresh), seen(batch));
}

// Variance s^2 and correlation exp(-T / time) from one env step to the next, in 4 standard
// deviations of their estimates.
TEST(Gusts, HaveTheirVarianceAndMemory) {
  constexpr int kWorlds = 60, kSteps = 60;
  json scene = ballScene();
  scene["gravity"] = {0, 0, 0};
  scene["model"] = "vacuum";
  BatchSettings settings = reading({{"flow"}, {"twist"}});
  settings.worlds = kWorlds;
  settings.gust = GaussMarkovGusts{{2, 2, 2}, 0.03};
  scene["model"] = "ambient";
  scene["bodies"][0]["mass"] = 1e6;
  WorldBatch batch(sceneFrom(scene), settings);
  double square = 0, product = 0;
  std::vector<double> before(kWorlds);
  for (int n = 0; n <= kSteps; ++n) {
    if (n > 0) batch.step();
    for (int i = 0; i < kWorlds; ++i) {
      const double gust = batch.observations()[9 * i + 2];
      if (n > 0) product += gust * before[static_cast<std::size_t>(i)];
      if (n > 0) square += gust * gust;
      before[static_cast<std::size_t>(i)] = gust;
    }
  }
  const double kept = std::exp(-0.01 / 0.03), independent = kWorlds * kSteps * (1 - kept);
  EXPECT_NEAR(square / (kWorlds * kSteps), 4, 4 * 4 * std::sqrt(2 / independent));
  EXPECT_NEAR(product / square, kept, 4 / std::sqrt(independent));
}

// A world's gusts are those of wind.h, whose seed is a number of its seed and episode.
TEST(Gusts, AreThoseOfTheirSeedAndEpisode) {
  json scene = ballScene();
  scene["bodies"][0]["linear_velocity"] = {0, 0, 0};
  BatchSettings settings = reading({{"flow"}});
  settings.seed = 5;
  settings.gust = GaussMarkovGusts{{1, 2, 3}, 1};
  const std::uint64_t seed =
      philox({0, static_cast<std::uint64_t>(RandomStream::kGust), 1, 0}, {5, 0})[0];
  const Vector3 expected = gaussMarkovGusts({{1, 2, 3}, 1, seed})({0, 0, 0}, 0).velocity;
  const std::vector<double> seen = read(scene, settings, 0);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(seen[static_cast<std::size_t>(i)], expected[i]);
}

// A twist added at the start to any link is one of the root link.
TEST(Variations, OfTheTwistOfALinkMoveTheWholeRobot) {
  Scene scene = readNamedScene("three_link_swimmer");
  scene.robots[0].angular_velocity = {0, 0, 1};
  const auto twistOfRoot = [&](const std::string& link) {
    BatchSettings settings = reading({{"twist_world", scene.bodies[0].name}});
    settings.threads = 1;
    settings.variations = {{"twist", link, {0, 0, 0, 1, 2, 3}, {0, 0, 0, 1, 2, 3}}};
    WorldBatch batch(scene, settings);
    return std::vector<double>(batch.observations(), batch.observations() + 6);
  };
  EXPECT_EQ(twistOfRoot(scene.bodies[2].name), twistOfRoot(scene.bodies[0].name));
}

TEST(WorldBatch, RefusesInOneLine) {
  const auto refusal = [](BatchSettings settings) {
    return test::refusalOf([&] { WorldBatch(sceneFrom(ballScene()), settings); });
  };
  EXPECT_EQ(
      refusal(reading({{"colour"}})).rfind("observations[0]: is \"colour\"; must be one of", 0), 0u)
      << refusal(reading({{"colour"}}));
  EXPECT_NE(refusal(reading({{"twist", "nobody"}})).find("names the body \"nobody\""),
            std::string::npos);
  EXPECT_NE(refusal(reading({{"twist", "", {6}}})).find("has the row 6; must be from 0 to 5"),
            std::string::npos);
  BatchSettings settings;
  settings.actions = {{"thrusters"}};
  EXPECT_EQ(refusal(settings), "actions[0]: is \"thrusters\", and the scene has no thrusters");
  settings.actions = {{"motor_velocity"}};
  EXPECT_EQ(refusal(settings), "actions[0]: is \"motor_velocity\", and the scene has no joints");
  settings = {};
  settings.variations = {{"mass", "", {0}, {1}}};
  EXPECT_NE(refusal(settings).find("is 0; must be > 0"), std::string::npos);
  settings.variations = {{"position", "", {0, 0}, {1, 1}}};
  EXPECT_NE(refusal(settings).find("has bounds of 2 numbers; must be 1 or 3"), std::string::npos);
  settings.variations = {{"mass", "", {1}, {1}}, {"mass", "ball", {2}, {2}}};
  EXPECT_EQ(refusal(settings), "variation \"mass\": is given twice");
  settings.variations = {};
  EXPECT_EQ(refusal(reading({{"parameters"}})), "observations[0]: has no numbers: nothing varies");
  settings.gust = GaussMarkovGusts{{1, std::nan(""), 1}, 1};
  EXPECT_EQ(
      test::refusalOf<std::invalid_argument>([&] { WorldBatch(sceneFrom(ballScene()), settings); }),
      "Gauss-Markov gusts: intensity [m/s] is nan; must be zero or positive and finite");
  settings.gust.reset();
  settings.worlds = 0;
  EXPECT_NE(refusal(settings).find("worlds: is 0; must be >= 1"), std::string::npos);
}

TEST(WorldBatch, RefusesWhatASceneCannotDo) {
  BatchSettings settings;
  const auto refusal = [&](const Scene& scene) {
    return test::refusalOf([&] { WorldBatch(scene, settings); });
  };
  for (const char* kind : {"mass", "inertia", "centre_of_mass"}) {
    settings.variations = {{kind, "floor", {1}, {1}}};
    EXPECT_NE(refusal(sceneFrom(boxOnFloor())).find("\"floor\", which is static"),
              std::string::npos);
  }
  settings.variations = {};
  settings.actions = {{"wrench", "floor"}};
  EXPECT_NE(refusal(sceneFrom(boxOnFloor())).find("\"floor\", which is static"), std::string::npos);
  settings.actions = {};
  json pushed = boxOnFloor();
  pushed["thrusters"] = json::array({{{"on", "box"}, {"curve", {{0, 0}, {1, 10}}}, {"lag", 0.1}}});
  settings.variations = {{"lag", "", {-1}, {1}}};
  EXPECT_EQ(refusal(sceneFrom(pushed)), "variation \"lag\": is -1; must be >= 0");
  settings.variations = {{"friction", "box", {-1}, {1}}};
  EXPECT_EQ(refusal(sceneFrom(pushed)), "variation \"friction\": is -1; must be >= 0");
  settings.variations = {{"centre_of_mass", "", {0}, {0.1}}};
  pushed["joints"] = json::array({{{"bodies", {"box"}}, {"point", {0, 0, 0.2}}}});
  EXPECT_EQ(refusal(sceneFrom(pushed)),
            "variation \"centre_of_mass\": names the body \"box\"; must have no joints");
  Scene swimmer = readNamedScene("three_link_swimmer");
  EXPECT_NE(refusal(swimmer).find("a link of a robot; must be a rigid body"), std::string::npos);
  settings.variations = {};
  settings.actions = {{"motor_position"}};
  EXPECT_EQ(refusal(swimmer), "");
  const std::string joint = swimmer.robots[0].model->links[2].joint.name;
  swimmer.robots[0].motors.erase(joint);
  EXPECT_EQ(refusal(swimmer),
            "actions[0]: drives the joint \"" + joint + "\", which has no motor in the scene");
  settings.actions[0].rows = {0};
  EXPECT_EQ(refusal(swimmer), "");
}

}  // namespace
}  // namespace ambient
