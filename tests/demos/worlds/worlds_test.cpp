// Worlds that step by one call.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "bullet_ambient/base/elementary.h"
#include "demos/simulation/robots/scene_robot.h"
#include "demos/worlds/batch_random.h"
#include "demos/worlds/world_batch.h"
#include "tests/demos/scene/scene_text.h"
#include "tests/demos/simulation/scenes/run_scene.h"
#include "tests/demos/worlds/vehicle_scene.h"
#include "tests/support/allocation_counter.h"

namespace ambient {
namespace {

using nlohmann::json;

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
  settings.gust = GaussMarkovGusts{{0.3, 0.2, 0.1}, 0.5};
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

TEST(WorldBatch, HasTheSameBitsInLanesAndAlone) {
  struct Case {
    Scene scene;
    BatchSettings settings;
  };
  const TemporaryFolder folder;
  std::vector<Case> cases{{sceneFrom(vehicle()), wildSettings(203, 1)}};
  BatchSettings plain = wildSettings(9, 1);
  plain.actions.clear();
  plain.observations = {{"position"}, {"twist"}, {"imu"}, {"flow"}};
  plain.variations = {{"position", "", {-0.1}, {0.1}}, {"current", "", {-0.2}, {0.2}}};
  for (const char* name : {"rov_station", "ball_on_bottom", "floating_cube", "glider"})
    cases.push_back({readNamedScene(name), plain});
  for (Case& of : cases) {
    of.settings.fluid_bodies = folder / "bodies";
    of.settings.together = 1;
    WorldBatch alone(of.scene, of.settings);
    const auto expected = play(alone, 10);
    of.settings.together = 8;
    for (const int worlds : {1, 7, 8, 9, 203}) {
      if (worlds > alone.worlds()) continue;
      for (const int threads : {1, 2, 3, 7}) {
        of.settings.worlds = worlds;
        of.settings.threads = threads;
        WorldBatch batch(of.scene, of.settings);
        const auto rows = play(batch, 10);
        EXPECT_TRUE(std::equal(rows.begin(), rows.end(), expected.begin()))
            << of.scene.name << worlds << threads;
      }
    }
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
  const std::uint64_t seeds[] = {3, 4};
  other.reset(nullptr, seeds);
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
  std::string bytes = before;
  const double bad = std::numeric_limits<double>::quiet_NaN();
  bytes.replace(40, sizeof bad, reinterpret_cast<const char*>(&bad), sizeof bad);  // a parameter
  EXPECT_THROW(batch.restore(0, bytes), std::runtime_error);
  EXPECT_TRUE(batch.state(0) == before);
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

// Of a body without fluid and of a link of a robot; what is large is no fault.
TEST(Simulation, IsAtFaultWhereAMotionIsNotFinite) {
  const double infinite = std::numeric_limits<double>::infinity();
  json text = vehicle();
  text["model"] = "vacuum";
  const TemporaryFolder folder;
  SceneBodyCache cache(folder / "bodies");
  const Scene free = sceneFrom(text), robot = readNamedScene("rov_station");
  Simulation body(free, prepareBodies(free, cache)), link(robot, prepareBodies(robot, cache));
  for (Simulation* simulation : {&body, &link}) {
    simulation->step();
    EXPECT_FALSE(simulation->fault());
  }
  body.setTwist(0, {Vector3::Zero(), {1e200, 0, 0}});
  EXPECT_FALSE(body.fault());
  body.setTwist(0, {Vector3::Zero(), {infinite, 0, 0}});
  EXPECT_NE(body.fault().value_or("").find("body \"hull\": its state is not finite"),
            std::string::npos);
  link.robot(0).robot().multiBody().setBaseOmega(btVector3(0, btScalar(infinite), 0));
  EXPECT_NE(link.fault().value_or("").find("its state is not finite"), std::string::npos);
}

constexpr std::uint64_t kAll = ~std::uint64_t{0};

// The first and the last from Random123's known answers; the others by numpy.random.Philox of NumPy
// 1.24, which adds 1 to its counter before it draws.
TEST(Philox, GivesTheKnownNumbers) {
  EXPECT_EQ(philox({0, 0, 0, 0}, {0, 0}), (RandomBlock{0x16554d9eca36314c, 0xdb20fe9d672d0fdc,
                                                       0xd7e772cee186176b, 0x7e68b68aec7ba23b}));
  EXPECT_EQ(philox({5, 2, 3, 9}, {77, 0}), (RandomBlock{0xc6bfedc7945cad01, 0xcb01ec7361cbc1cf,
                                                        0x4c030d8debb7e438, 0x4761429bb19cc8f4}));
  EXPECT_EQ(philox({kAll, kAll, kAll, kAll}, {kAll, kAll}),
            (RandomBlock{0x87b092c3013fe90b, 0x438c3c67be8d0224, 0x9cc7d7c69cd777b6,
                         0xa09caebf594f0ba0}));
}

TEST(RandomNumbers, AreFunctionsOfTheirPlace) {
  RandomNumbers numbers({77, RandomStream::kNoise, 3, 9}), again({77, RandomStream::kNoise, 3, 9});
  const RandomBlock first = philox({0, 2, 3, 9}, {77, 0}), second = philox({1, 2, 3, 9}, {77, 0});
  for (int k = 0; k < 6; ++k) {
    const std::uint64_t bits =
        k < 4 ? first[static_cast<std::size_t>(k)] : second[static_cast<std::size_t>(k - 4)];
    const double expected = std::ldexp(static_cast<double>(bits >> 11), -53);
    EXPECT_EQ(numbers.uniform(), expected);
    EXPECT_EQ(again.uniform(), expected);
  }
}

// Mean, variance and fourth moment of 20000 normal numbers, within 4 standard deviations of each.
TEST(RandomNumbers, OfANormalDistribution) {
  constexpr int kCount = 20000;
  RandomNumbers numbers({5, RandomStream::kNoise, 0, 0});
  double mean = 0, square = 0, fourth = 0;
  for (int i = 0; i < kCount; ++i) {
    const double x = numbers.normal();
    mean += x / kCount;
    square += x * x / kCount;
    fourth += x * x * x * x / kCount;
  }
  const double sigma = 4 / std::sqrt(kCount);
  EXPECT_NEAR(mean, 0, sigma);
  EXPECT_NEAR(square, 1, sigma * std::sqrt(2));
  EXPECT_NEAR(fourth, 3, sigma * std::sqrt(96));
}

}  // namespace
}  // namespace ambient
