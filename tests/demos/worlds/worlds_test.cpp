#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "bullet_ambient/base/elementary.h"
#include "demos/simulation/robots/scene_robot.h"
#include "demos/worlds/world_batch.h"
#include "tests/demos/scene/scene_text.h"
#include "tests/demos/simulation/scenes/run_scene.h"
#include "tests/support/allocation_counter.h"

// Worlds that step by one call.
namespace ambient {
namespace {

using nlohmann::json;

/// A box of unequal sides with two thrusters, deep in water that stands still.
json vehicle() {
  json scene = ballScene();
  scene["medium"] = {{"density", 1000}, {"viscosity", 1e-3}};
  scene["bodies"] = json::array({{{"name", "hull"},
                                  {"shape", {{"type", "box"}, {"size", {0.5, 0.3, 0.2}}}},
                                  {"mass", 31},
                                  {"position", {0, 0, 1}}}});
  const json curve = {{-1, -30}, {0, 0}, {1, 40}};
  scene["thrusters"] = json::array(
      {{{"on", "hull"}, {"position", {-0.2, 0.1, 0}}, {"curve", curve}, {"lag", 0.1}},
       {{"on", "hull"}, {"position", {-0.2, -0.1, 0}}, {"curve", curve}, {"lag", 0.1}}});
  return scene;
}

/// All that a batch can vary, and a sensor of each kind that hangs on the past.
BatchSettings wildSettings(int worlds, int threads) {
  BatchSettings settings;
  settings.worlds = worlds;
  settings.threads = threads;
  settings.substeps = 2;
  settings.seed = 11;
  settings.most_steps = 6;
  settings.actions = {{"thrusters"}};
  settings.observations = {{"position"}, {"rotation"}, {"twist"}, {"imu"},
                           {"flow"},     {"thrust"},   {"target"}};
  settings.observations[2].noise = 0.1;
  settings.observations[2].bias = 0.2;
  settings.variations = {{"mass", "", {0.8}, {1.2}},           {"inertia", "", {0.9}, {1.1}},
                         {"added_mass", "", {0.5}, {2}, true}, {"loads", "", {0.5}, {2}, true},
                         {"current", "", {-1}, {1}},           {"position", "", {-1}, {1}},
                         {"attitude", "", {-0.5}, {0.5}},      {"twist", "", {-0.3}, {0.3}},
                         {"thrust", "", {0.8}, {1.2}},         {"lag", "", {0.5}, {2}},
                         {"target", "", {0, 0, 0}, {3, 2, 1}}};
  settings.gust = GustDef{{0.3, 0.2, 0.1}, 0.5};
  return settings;
}

/// Actions of world i in its n-th call.
double actionOf(int seed, int n, int k) { return portable::sin(1.3 * seed + 0.7 * n + k); }

/// Observations and parameters of `calls` calls; worlds are reset when they are truncated. `first`:
/// number of the first world.
std::vector<std::vector<double>> play(WorldBatch& batch, int calls, int first = 0) {
  const int count = batch.worlds(), wide = batch.plan().action_size;
  std::vector<std::vector<double>> rows(static_cast<std::size_t>(count));
  for (int n = 0; n < calls; ++n) {
    for (int i = 0; i < count; ++i)
      for (int k = 0; k < wide; ++k) batch.actions()[i * wide + k] = actionOf(first + i, n, k);
    const std::vector<std::uint8_t> over(batch.truncated(), batch.truncated() + count);
    batch.step(over.data());
    for (int i = 0; i < count; ++i) {
      const auto add = [&](const double* from, int size) {
        rows[static_cast<std::size_t>(i)].insert(rows[static_cast<std::size_t>(i)].end(),
                                                 from + i * size, from + (i + 1) * size);
      };
      add(batch.observations(), batch.plan().observation_size);
      add(batch.parameters(), batch.plan().parameter_size);
    }
  }
  return rows;
}

TEST(WorldBatch, HasTheSameBitsAtAnyNumberOfThreadsAndAsBatchesOfOne) {
  constexpr int kWorlds = 9, kCalls = 16;
  const Scene scene = sceneFrom(vehicle());
  WorldBatch alone(scene, wildSettings(kWorlds, 1));
  const auto expected = play(alone, kCalls);
  EXPECT_NE(expected[0], expected[1]);
  for (const int threads : {2, 3, 7}) {
    WorldBatch batch(scene, wildSettings(kWorlds, threads));
    EXPECT_EQ(play(batch, kCalls), expected) << threads;
  }
  for (int i = 0; i < kWorlds; i += 4) {
    BatchSettings settings = wildSettings(1, 1);
    settings.seed += static_cast<std::uint64_t>(i);
    WorldBatch one(scene, settings);
    EXPECT_EQ(play(one, kCalls, i)[0], expected[static_cast<std::size_t>(i)]) << i;
  }
}

BatchSettings plainSettings(const std::vector<ActionDef>& actions) {
  BatchSettings settings;
  settings.worlds = 2;
  settings.substeps = 3;
  settings.threads = 1;
  settings.actions = actions;
  settings.observations = {{"position"}, {"orientation"}, {"twist_world"}};
  return settings;
}

/// Compares a batch to a simulation that gets the same forces by push(simulation, n).
void expectBitsOfSimulation(const Scene& scene, BatchSettings settings,
                            const std::function<void(Simulation&, int)>& push) {
  const TemporaryFolder folder;
  settings.fluid_bodies = folder / "bodies";
  WorldBatch batch(scene, settings);
  SceneBodyCache cache(settings.fluid_bodies);
  Simulation simulation(scene, prepareBodies(scene, cache));
  std::size_t moving = 0;
  while (scene.bodies[moving].mass == 0) ++moving;
  for (int n = 0; n < 30; ++n) {
    for (int k = 0; k < batch.plan().action_size; ++k)
      batch.actions()[batch.plan().action_size + k] = actionOf(0, n, k);
    batch.step();
    for (int k = 0; k < settings.substeps; ++k) {
      push(simulation, n);
      simulation.step();
    }
    const MotionSample now = simulation.sample(moving);
    const double* seen = batch.observations() + batch.plan().observation_size;
    EXPECT_EQ(Vector3(seen[0], seen[1], seen[2]), now.position) << scene.name << n;
    EXPECT_EQ(Vector3(seen[10], seen[11], seen[12]), now.twist.linear) << scene.name << n;
    ASSERT_FALSE(::testing::Test::HasFailure());
  }
}

TEST(WorldBatch, HasTheBitsOfASimulation) {
  expectBitsOfSimulation(
      sceneFrom(vehicle()), plainSettings({{"thrusters"}}), [](Simulation& simulation, int n) {
        for (int k = 0; k < 2; ++k)
          simulation.thrusters().command(static_cast<std::size_t>(k), actionOf(0, n, k));
      });
  expectBitsOfSimulation(sceneFrom(vehicle()), plainSettings({{"wrench_world", "", {}, 2}}),
                         [](Simulation& simulation, int n) {
                           const auto x = [n](int k) { return 2 * actionOf(0, n, k); };
                           simulation.apply(0, {{x(0), x(1), x(2)}, {x(3), x(4), x(5)}});
                         });
  const auto nothing = [](Simulation&, int) {};
  for (const char* name : {"rov", "ball_on_bottom", "glider"})
    expectBitsOfSimulation(readNamedScene(name), plainSettings({}), nothing);
  const Scene swimmer = readNamedScene("three_link_swimmer");
  const std::vector<LinkModel>& links = swimmer.robots[0].model->links;
  expectBitsOfSimulation(swimmer, plainSettings({{"motor_velocity", "", {0}, 2}}),
                         [&](Simulation& simulation, int n) {
                           JointDrive drive = swimmer.robots[0].motors.at(links[1].joint.name);
                           drive.velocity = 2 * actionOf(0, n, 0);
                           simulation.robot(0).setDrive(links[1].joint.name, drive);
                         });
}

TEST(WorldBatch, AWorldAfterItsResetIsAsNew) {
  const Scene scene = sceneFrom(vehicle());
  BatchSettings settings = wildSettings(2, 1);
  WorldBatch batch(scene, settings), fresh(scene, settings);
  play(batch, 5);
  const std::uint64_t seeds[] = {11, 12};
  const std::uint8_t second[] = {0, 1};
  const std::vector<double> first(batch.observations(),
                                  batch.observations() + batch.plan().observation_size);
  batch.reset(second, seeds);
  const auto rows = play(batch, 4), expected = play(fresh, 4);
  EXPECT_EQ(rows[1], expected[1]);
  EXPECT_NE(rows[0], expected[0]);
  EXPECT_EQ(batch.episodes()[1], 1u);
  EXPECT_EQ(batch.truncated()[0], 0);  // reset within play()
}

TEST(WorldBatch, RunsAsInALoop) {
  const Scene scene = sceneFrom(vehicle());
  BatchSettings settings = wildSettings(3, 2);
  settings.most_steps = 0;
  WorldBatch batch(scene, settings), loop(scene, settings);
  constexpr int kSteps = 5;
  const int wide = batch.plan().action_size, seen = batch.plan().observation_size;
  std::vector<double> actions(static_cast<std::size_t>(3 * kSteps * wide));
  for (std::size_t i = 0; i < actions.size(); ++i) actions[i] = actionOf(0, static_cast<int>(i), 0);
  std::vector<double> observations(static_cast<std::size_t>(3 * kSteps * seen));
  batch.run(actions.data(), kSteps, observations.data(), 0, 2);
  batch.run(actions.data(), kSteps, observations.data(), 2, kSteps);
  for (int t = 0; t < kSteps; ++t) {
    for (int i = 0; i < 3; ++i)
      std::copy_n(&actions[static_cast<std::size_t>((i * kSteps + t) * wide)], wide,
                  loop.actions() + i * wide);
    loop.step();
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < seen; ++k)
        EXPECT_EQ(observations[static_cast<std::size_t>((i * kSteps + t) * seen + k)],
                  loop.observations()[i * seen + k]);
  }
}

TEST(WorldBatch, GoesOnFromBytes) {
  const Scene scene = sceneFrom(vehicle());
  BatchSettings settings = wildSettings(2, 1);
  settings.most_steps = 0;
  WorldBatch batch(scene, settings), other(scene, settings);
  play(batch, 4);
  play(other, 7, 5);
  for (int i = 0; i < 2; ++i) other.restore(i, batch.state(i));
  for (int k = 0; k < 2 * batch.plan().observation_size; ++k)
    EXPECT_EQ(other.observations()[k], batch.observations()[k]) << k;
  EXPECT_EQ(play(other, 6), play(batch, 6));
  EXPECT_THROW(other.restore(0, "nothing"), std::runtime_error);
  EXPECT_THROW(other.restore(0, batch.state(0).substr(0, 300)), std::runtime_error);
}

TEST(WorldBatch, ARefusedStateLeavesAWorldAsItWas) {
  BatchSettings settings = wildSettings(1, 1);
  WorldBatch batch(sceneFrom(vehicle()), settings);
  play(batch, 4);
  const std::string before = batch.state(0);
  // Offsets of a gust and of the first parameter.
  for (const std::size_t place : {40u, 88u}) {
    std::string bytes = before;
    const double bad = std::numeric_limits<double>::quiet_NaN();
    bytes.replace(place, sizeof bad, reinterpret_cast<const char*>(&bad), sizeof bad);
    EXPECT_THROW(batch.restore(0, bytes), std::runtime_error);
    EXPECT_TRUE(batch.state(0) == before) << place;
  }
}

// After a reset or a restore it is that of the present state, whatever the world did before.
TEST(WorldBatch, TheWrenchOfTheFluidForgetsTheLastEpisode) {
  BatchSettings settings = wildSettings(1, 1);
  settings.most_steps = 0;
  settings.observations = {{"fluid_wrench"}};
  WorldBatch batch(sceneFrom(vehicle()), settings), fresh(sceneFrom(vehicle()), settings);
  const auto seen = [](WorldBatch& of) {
    return std::vector<double>(of.observations(), of.observations() + 6);
  };
  const std::vector<double> expected = seen(fresh);
  EXPECT_NE(expected, std::vector<double>(6));
  play(batch, 4);
  EXPECT_NE(seen(batch), expected);
  const std::uint64_t seed = settings.seed;
  batch.reset(nullptr, &seed);
  EXPECT_EQ(seen(batch), expected);
  play(batch, 4);
  batch.restore(0, fresh.state(0));
  fresh.restore(0, fresh.state(0));
  EXPECT_EQ(seen(batch), seen(fresh));
}

TEST(WorldBatch, AStepAllocatesNothing) {
  BatchSettings settings = wildSettings(3, 1);
  settings.most_steps = 0;
  settings.observations.insert(settings.observations.end(), {{"contact"}, {"wet"}, {"depth"}});
  WorldBatch batch(sceneFrom(vehicle()), settings);
  for (int n = 0; n < 3; ++n) batch.step();
  const std::size_t before = test::allocationCount();
  for (int n = 0; n < 10; ++n) batch.step();
  EXPECT_EQ(test::allocationCount(), before);
}

TEST(WorldBatch, AWorldFailsAlone) {
  const Scene scene = sceneFrom(vehicle());
  BatchSettings settings = plainSettings({{"wrench_world"}});
  settings.worlds = 4;
  WorldBatch batch(scene, settings), calm(scene, settings);
  const auto positionOf = [](WorldBatch& of, int i) {
    return of.observations()[i * of.plan().observation_size];
  };
  batch.actions()[1 * 6 + 3] = 1e306;
  batch.actions()[2 * 6 + 4] = std::numeric_limits<double>::quiet_NaN();
  for (WorldBatch* both : {&batch, &calm}) {
    both->actions()[3 * 6 + 3] = 5;
    for (int n = 0; n < 5; ++n) both->step();
  }
  EXPECT_EQ(std::vector<std::uint8_t>(batch.failed(), batch.failed() + 4),
            (std::vector<std::uint8_t>{0, 1, 1, 0}));
  EXPECT_NE(batch.fault(1).find("body \"hull\": its state is not finite"), std::string::npos);
  EXPECT_EQ(batch.fault(2), "the action wrench_world[4] is not finite");
  EXPECT_TRUE(std::isnan(positionOf(batch, 1)) && std::isnan(positionOf(batch, 2)));
  EXPECT_THROW(batch.state(1), std::runtime_error);
  for (const int i : {0, 3}) EXPECT_EQ(positionOf(batch, i), positionOf(calm, i));
  EXPECT_GT(positionOf(batch, 3), 0);
  std::fill_n(batch.actions(), 24, 0.0);
  std::fill_n(calm.actions(), 24, 0.0);
  batch.reset();
  calm.reset();
  for (int n = 0; n < 5; ++n) {
    batch.step();
    calm.step();
  }
  for (int i = 0; i < 4; ++i) EXPECT_EQ(positionOf(batch, i), positionOf(calm, i));
}

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

TEST(Thrusters, WithNumbersAreInSavedStates) {
  json text = screwed();
  text["thrusters"][0]["lag"] = 0.1;
  const Scene scene = sceneFrom(text);
  Simulation one(scene, prepare(scene)), other(scene, prepare(scene));
  for (Simulation* simulation : {&one, &other}) simulation->thrusters().command(0, 1);
  for (int n = 0; n < 5; ++n) one.step();
  other.restoreState(one.saveState());
  for (int n = 0; n < 5; ++n) {
    const ThrusterState &a = one.thrusters().states()[0], &b = other.thrusters().states()[0];
    EXPECT_EQ(a.drive, b.drive);
    EXPECT_EQ(a.load.power, b.load.power);
    EXPECT_EQ(one.sample(0).position, other.sample(0).position);
    one.step();
    other.step();
  }
  std::string damaged = one.saveState();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::memcpy(damaged.data() + sizeof(long long), &nan, sizeof nan);
  EXPECT_ANY_THROW(other.restoreState(damaged));
}

TEST(Thrusters, AreInSavedStates) {
  const Scene scene = sceneFrom(vehicle());
  Simulation one(scene, prepare(scene)), other(scene, prepare(scene));
  one.thrusters().command(0, 1);
  for (int n = 0; n < 5; ++n) one.step();
  other.thrusters().command(0, 1);
  other.restoreState(one.saveState());
  EXPECT_EQ(thrustsOf(other), thrustsOf(one));
  for (int n = 0; n < 5; ++n) {
    one.step();
    other.step();
  }
  EXPECT_EQ(other.sample(0).position, one.sample(0).position);
}

}  // namespace
}  // namespace ambient
