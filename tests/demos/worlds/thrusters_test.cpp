#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "bullet_ambient/base/pi.h"
#include "demos/worlds/world_batch.h"
#include "tests/demos/scene/scene_text.h"
#include "tests/demos/simulation/scenes/run_scene.h"
#include "tests/demos/worlds/vehicle_scene.h"

namespace ambient {
namespace {

using nlohmann::json;

std::vector<double> thrustsOf(const Simulation& simulation) {
  std::vector<double> thrusts;
  for (const ThrusterState& state : simulation.thrusters().states())
    thrusts.push_back(state.load.thrust);
  return thrusts;
}

// v(t) of docs/thrusters.md with implicit Euler: F (1 - (lag / (lag + h))^n).
TEST(Thrusters, FollowTheirCommands) {
  const Scene scene = sceneFrom(vehicle());
  Simulation simulation(scene, prepare(scene));
  simulation.thrusters().command(0, 0.5);
  simulation.thrusters().command(1, -2);
  for (int n = 0; n < 12; ++n) simulation.step();
  const double reached = 1 - std::pow(0.1 / (0.1 + scene.time_step), 12);
  EXPECT_NEAR(thrustsOf(simulation)[0], 20 * reached, 1e-12);
  EXPECT_NEAR(thrustsOf(simulation)[1], -30 * reached, 1e-12);
  EXPECT_THROW(simulation.thrusters().command(1, std::numeric_limits<double>::infinity()),
               std::invalid_argument);
}

TEST(Thrusters, PushAlongTheirAxesAtTheirPlaces) {
  json text = vehicle();
  text["model"] = "vacuum";
  text["gravity"] = {0, 0, 0};
  text["bodies"][0]["inertia"] = {0.2, 0.3, 0.4, 0, 0, 0};
  text["thrusters"] = json::array({{{"on", "hull"},
                                    {"position", {0, 0.2, 0}},
                                    {"axis", {0, 0, 2}},
                                    {"torque_per_thrust", 0.05},
                                    {"curve", {{0, 0}, {1, 10}}}}});
  const Scene scene = sceneFrom(text);
  Simulation simulation(scene, prepare(scene));
  simulation.thrusters().command(0, 1);
  simulation.step();
  const Twist twist = simulation.sample(0).twist;
  const double h = scene.time_step;
  EXPECT_NEAR((twist.linear - Vector3(0, 0, 10 * h / 31)).norm(), 0, 1e-15);
  EXPECT_NEAR((twist.angular - Vector3(2 * h / 0.2, 0, 0.5 * h / 0.4)).norm(), 0, 1e-15);
}

// A disc whose middle is at the surface gives half of its thrust, and none above.
TEST(Thrusters, OfDryDiscsGiveLess) {
  for (const double above : {0.0, 0.05, 0.2, -0.2}) {
    json text = vehicle();
    text["model"] = "vacuum";
    text["gravity"] = {0, 0, -9.81};
    text["water"] = {{"level", 1 - above}};
    text["thrusters"] =
        json::array({{{"on", "hull"}, {"radius", 0.1}, {"curve", {{0, 0}, {1, 10}}}}});
    const Scene scene = sceneFrom(text);
    Simulation simulation(scene, prepare(scene));
    simulation.thrusters().command(0, 1);
    simulation.step();
    const double wet = std::min(1.0, std::max(0.0, 0.5 - above / 0.2));
    EXPECT_NEAR(simulation.sample(0).twist.linear.x(), wet * 10 * scene.time_step / 31, 1e-15);
  }
}

TEST(Thrusters, StayWhereAStateIsRefused) {
  json more = vehicle();
  more["bodies"].push_back({{"name", "floor"},
                            {"mass", 0},
                            {"shape", {{"type", "box"}, {"size", {4, 4, 1}}}},
                            {"position", {0, 0, -9}}});
  const Scene scene = sceneFrom(vehicle()), wider = sceneFrom(more);
  Simulation one(scene, prepare(scene)), other(wider, prepare(wider));
  other.thrusters().command(0, 1);
  other.step();
  EXPECT_ANY_THROW(one.restoreState(other.saveState()));
  EXPECT_EQ(thrustsOf(one), (std::vector<double>{0, 0}));
}

constexpr WageningenScrew kScrew{4, 0.55, 1};

/// The vehicle without weight and lag, with a screw of 0.1 m that turns 30 times a second.
json screwed(const std::string& model = "ambient", const std::string& hand = "right") {
  json text = vehicle();
  text["model"] = model;
  text["gravity"] = {0, 0, 0};
  text["bodies"][0]["inertia"] = {0.2, 0.3, 0.4, 0, 0, 0};
  const json screw = {{"blades", 4}, {"area_ratio", 0.55}, {"pitch_ratio", 1}};
  text["thrusters"] =
      json::array({{{"on", "hull"},
                    {"position", {-0.2, 0.1, 0}},
                    {"curve", {{-1, -30}, {1, 30}}},
                    {"propeller", {{"diameter", 0.1}, {"wageningen", screw}, {"hand", hand}}}}});
  return text;
}

TEST(Thrusters, WithNumbersSeeTheFluidAtTheirDiscs) {
  json text = screwed();
  text["medium"]["velocity"] = {0.3, 0.5, 0};
  text["bodies"][0]["linear_velocity"] = {1, 0, 0};
  text["bodies"][0]["angular_velocity"] = {0, 0, 2};
  const Scene scene = sceneFrom(text);
  Simulation simulation(scene, prepare(scene));
  simulation.thrusters().command(0, 1);
  simulation.step();
  const PropellerLoad expected =
      Propeller::wageningen(0.1, kScrew).load(30, 1 - 2 * 0.1 - 0.3, 1000);
  const PropellerLoad& load = simulation.thrusters().states()[0].load;
  EXPECT_NEAR(load.thrust, expected.thrust, 1e-12 * expected.thrust);
  EXPECT_NEAR(load.torque, expected.torque, 1e-12 * expected.torque);
  EXPECT_NEAR(load.power, expected.power, 1e-12 * expected.power);
  simulation.thrusters().setFactors(0, 0.5, 1);
  simulation.step();
  EXPECT_LT(simulation.thrusters().states()[0].load.thrust, 0.51 * expected.thrust);
}

// m dv = h T, I dw = h (r x T - Q) of a right-handed screw; half of both where half is wet.
TEST(Thrusters, WithNumbersPushAndTurnTheirBodies) {
  for (const std::string hand : {"right", "left"})
    for (const double level : {9.0, 1.0}) {
      json text = screwed("vacuum", hand);
      text["gravity"] = {0, 0, -9.81};
      text["water"] = {{"level", level}, {"density", 1000}};
      const Scene scene = sceneFrom(text);
      Simulation simulation(scene, prepare(scene));
      simulation.thrusters().command(0, 1);
      simulation.step();
      const PropellerLoad load =
          (level > 1 ? 1 : 0.5) * Propeller::wageningen(0.1, kScrew).load(30, 0, 1000);
      const double h = scene.time_step, turning = hand == "left" ? 1 : -1;
      const Twist twist = simulation.sample(0).twist;
      EXPECT_NEAR(twist.linear.x(), h * load.thrust / 31, 1e-14);
      EXPECT_NEAR(twist.angular.x(), h * turning * load.torque / 0.2, 1e-14);
      EXPECT_NEAR(twist.angular.z(), -h * 0.1 * load.thrust / 0.4, 1e-14);
    }
}

// Energy of body and fluid relative to water at rest.
double energyOf(const Simulation& simulation) { return simulation.vessel(0).kineticEnergy(); }

TEST(Thrusters, GiveNoMoreThanTheirShaftsAtAnyStep) {
  std::vector<double> speeds;
  for (const int rate : {30, 60, 240}) {
    json text = screwed();
    text["time_step"] = 1.0 / rate;
    text["thrusters"].push_back(text["thrusters"][0]);
    text["thrusters"][1]["position"] = {-0.2, -0.1, 0};
    text["thrusters"][1]["propeller"]["hand"] = "left";
    const Scene scene = sceneFrom(text);
    Simulation simulation(scene, prepare(scene));
    double energy = energyOf(simulation), given = 0;
    const auto go = [&](int seconds) {
      for (int n = 0; n < seconds * rate; ++n) {
        simulation.step();
        for (const ThrusterState& state : simulation.thrusters().states())
          given += state.load.power / rate;
        ASSERT_LE(energyOf(simulation), energy + given * (1 + 1e-9) + 1e-9) << rate;
      }
    };
    for (const std::size_t i : {0, 1}) simulation.thrusters().command(i, 1);
    go(6);
    speeds.push_back(simulation.sample(0).twist.linear.x());
    // Stopped and turned astern they brake; blades that stand still take energy alone.
    for (const std::size_t i : {0, 1}) simulation.thrusters().command(i, 0);
    energy = energyOf(simulation);
    given = 0;
    go(2);
    EXPECT_EQ(given, 0);
    for (const std::size_t i : {0, 1}) simulation.thrusters().command(i, -1);
    go(6);
    EXPECT_LT(simulation.sample(0).twist.linear.x(), -1);
  }
  // A steady speed does not depend on the step.
  for (const double speed : speeds) EXPECT_NEAR(speed, speeds[2], 1e-3 * speeds[2]);
  EXPECT_GT(speeds[2], 1);
}

// Foils of scenes, and the wash of propellers on them.

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

TEST(FoilsInScenes, FollowTheirCommands) {
  const Scene scene = boat(0, 1);
  Simulation simulation(scene, prepareSharing(scene));
  simulation.foils().command(0, 1);
  EXPECT_THROW(simulation.foils().command(0, std::numeric_limits<double>::infinity()),
               std::invalid_argument);
  for (int n = 0; n < 20; ++n) simulation.step();
  const double reached = 1 - std::pow(0.5 / (0.5 + scene.time_step), 20);
  EXPECT_NEAR(simulation.foils().angle(0), -0.6 * reached, 1e-12);
}

TEST(FoilsInScenes, AndThrustersAreInSavedStates) {
  const Scene scene = readNamedScene("rudder_and_screw");
  expectSavedStatesGoOn(scene);
  Simulation one(scene, prepareSharing(scene)), other(scene, prepareSharing(scene));
  one.step();
  std::string state = one.saveState();
  other.restoreState(state);
  EXPECT_EQ(other.thrusters().states()[0].load.power, one.thrusters().states()[0].load.power);
  EXPECT_EQ(other.foils().angle(0), one.foils().angle(0));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::memcpy(state.data() + sizeof(long long), &nan, sizeof nan);
  EXPECT_ANY_THROW(other.restoreState(state));
}

// Worlds of a batch turn foils of their own, from one state at the start, and observe them.
TEST(FoilsInScenes, TurnInEachWorldOfABatch) {
  BatchSettings settings;
  settings.worlds = 2;
  settings.substeps = 60;
  settings.actions = {{"foils"}};
  settings.observations = {{"heading"}, {"turns"}, {"foil_angle"}};
  WorldBatch batch(boat(0, 1), settings);
  for (int n = 0; n < 5; ++n) {
    batch.actions()[0] = 1;
    batch.actions()[1] = -1;
    batch.step();
  }
  EXPECT_GT(batch.observations()[1], 0.1);
  EXPECT_LT(batch.observations()[5], -0.1);
  for (int i = 0; i < 2; ++i) {
    Simulation& world = batch.world(i).simulation();
    EXPECT_EQ(batch.observations()[4 * i + 2], world.thrusters().states()[0].drive);
    EXPECT_EQ(batch.observations()[4 * i + 3], world.foils().angle(0));
  }
  EXPECT_GT(batch.observations()[2], 9);
  EXPECT_LT(batch.observations()[3], -0.5);
  EXPECT_GT(batch.observations()[7], 0.5);
}

}  // namespace
}  // namespace ambient
