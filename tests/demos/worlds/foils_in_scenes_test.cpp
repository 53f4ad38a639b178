#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "bullet_ambient/base/pi.h"
#include "demos/worlds/world_batch.h"
#include "tests/demos/scene/scene_text.h"
#include "tests/demos/simulation/scenes/run_scene.h"

// Foils of scenes, and the wash of propellers on them.
namespace ambient {
namespace {

using nlohmann::json;

/// The boat of data/scenes/rudder_and_screw, with other commands.
Scene boat(double rudder, double screw, const std::string& speed = "0") {
  return readNamedScene("rudder_and_screw",
                        {{"foils.0.command", std::to_string(rudder)},
                         {"thrusters.0.command", std::to_string(screw)},
                         {"bodies.0.linear_velocity", "[" + speed + ", 0, 0]"}});
}

/// Its turn to the left after some seconds [rad].
double turnedAfter(const Scene& scene, double seconds) {
  Simulation simulation(scene, prepareSharing(scene));
  for (int n = 0; n < seconds / scene.time_step; ++n) simulation.step();
  const Vector3 bow = simulation.sample(0).orientation * Vector3::UnitX();
  return std::atan2(bow.y(), bow.x());
}

// A rudder turns a boat that lies still only in the wash of its screw. What the screw's own torque
// turns, it turns both ways.
TEST(FoilsInScenes, TurnABoatAtRestInTheWashOfItsScrew) {
  const double left = turnedAfter(boat(0.8, 1), 6), right = turnedAfter(boat(-0.8, 1), 6);
  EXPECT_GT(left, 0.3);
  EXPECT_LT(right, -0.3);
  EXPECT_LT(std::abs(turnedAfter(boat(0, 1), 6)), 0.1 * left);
  EXPECT_LT(std::abs(turnedAfter(boat(0.8, 0), 6)), 1e-3);
  // Under way it turns without.
  EXPECT_GT(turnedAfter(boat(0.8, 0, "3"), 6), 0.1);
}

// With no fluid on the hull, m dv and I dw are those of the thrust and of a rudder whose share in
// the jet, eq. (170), (171), moves through the water with the jet's velocity.
TEST(FoilsInScenes, FeelTheWashOfMomentumTheory) {
  json text = ballScene();
  text["model"] = "vacuum";
  text["gravity"] = {0, 0, -9.81};
  text["water"] = {{"level", 9}, {"density", 1000}};
  text["bodies"] = json::array({{{"name", "hull"},
                                 {"shape", {{"type", "box"}, {"size", {2, 1, 1}}}},
                                 {"inertia", {40, 50, 60, 0, 0, 0}},
                                 {"mass", 500}}});
  text["thrusters"] = json::array({{{"on", "hull"},
                                    {"position", {-1, 0, 0}},
                                    {"curve", {{0, 0}, {1, 300}}},
                                    {"command", 1},
                                    {"propeller", {{"diameter", 0.3}}}}});
  text["foils"] = json::array({{{"on", "hull"},
                                {"position", {-1.2, 0.05, 0}},
                                {"span_axis", {0, 0, 1}},
                                {"span", 0.5},
                                {"chord", 0.2},
                                {"curve", {{0, 0}, {1, 0.3}}},
                                {"command", 1}}});
  const Scene scene = sceneFrom(text);
  Simulation simulation(scene, prepareSharing(scene));
  simulation.step();
  EXPECT_EQ(simulation.foils().angle(0), 0.3);
  const double mass = 1000 * kPi / 4 * 0.09, induced = std::sqrt(300 / (2 * mass));
  const double jet = induced * (1 + 0.2 / std::sqrt(0.04 + 0.0225));
  const double radius = 0.15 * std::sqrt(induced / jet);
  const double share = std::sqrt(radius * radius - 0.05 * 0.05) / 0.25;
  Foils foils({scene.foils[0].foil});
  foils.turn(0, 0.3);
  const Wrench wash = foils.load({Vector3::Zero(), {jet, 0, 0}}, share * 1000, nullptr);
  const double h = scene.time_step;
  const Twist twist = simulation.sample(0).twist;
  EXPECT_NEAR(500 * twist.linear.x() / h, 300 + wash.force.x(), 1e-9);
  EXPECT_NEAR(500 * twist.linear.y() / h, wash.force.y(), 1e-9);
  EXPECT_NEAR(60 * twist.angular.z() / h, wash.torque.z(), 1e-9);
  EXPECT_GT(wash.force.y(), 20);
}

TEST(FoilsInScenes, FollowTheirCommandsAndAreInSavedStates) {
  const Scene scene = boat(0, 1);
  const auto prepared = prepareSharing(scene);
  Simulation one(scene, prepared), other(scene, prepared);
  one.foils().command(0, 1);
  EXPECT_THROW(one.foils().command(0, std::numeric_limits<double>::infinity()),
               std::invalid_argument);
  for (int n = 0; n < 20; ++n) one.step();
  const double reached = 1 - std::pow(0.5 / (0.5 + scene.time_step), 20);
  EXPECT_NEAR(one.foils().angle(0), -0.6 * reached, 1e-12);
  other.foils().command(0, 1);
  other.restoreState(one.saveState());
  for (int n = 0; n < 20; ++n) {
    EXPECT_EQ(one.foils().angle(0), other.foils().angle(0));
    EXPECT_EQ(one.sample(0).position, other.sample(0).position);
    EXPECT_EQ(one.sample(0).orientation.coeffs(), other.sample(0).orientation.coeffs());
    one.step();
    other.step();
  }
}

// Worlds of a batch turn foils of their own, from one state at the start.
TEST(FoilsInScenes, TurnInEachWorldOfABatch) {
  BatchSettings settings;
  settings.worlds = 2;
  settings.substeps = 60;
  settings.actions = {{"foils"}};
  settings.observations = {{"heading"}};
  WorldBatch batch(boat(0, 1), settings);
  for (int n = 0; n < 5; ++n) {
    batch.actions()[0] = 1;
    batch.actions()[1] = -1;
    batch.step();
  }
  EXPECT_GT(batch.observations()[1], 0.1);
  EXPECT_LT(batch.observations()[3], -0.1);
}

}  // namespace
}  // namespace ambient
