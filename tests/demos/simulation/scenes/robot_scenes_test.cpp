#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>

#include "demos/simulation/output/run_files.h"
#include "demos/simulation/simulation.h"
#include "tests/demos/simulation/scenes/run_scene.h"
#include "tests/reference/ellipsoid_added_mass.h"
#include "tests/reference/three_link_swimmer.h"

namespace ambient {
namespace {

constexpr double kTwoPi = 6.283185307179586;
constexpr double kStroke = 2;  // seconds

/// Swimmer of data/robots/three_link_swimmer.urdf, as dense as its water, 1000 kg/m^3.
reference::ThreeLinkSwimmer swimmerOfScene() {
  const Eigen::Vector3d axes(0.5, 0.1, 0.2);
  const double density = 1000, mass = density * kTwoPi * 2 / 3 * axes.prod();
  const auto added = reference::ellipsoidAddedMass(axes);
  return {mass + density * added[3], mass + density * added[4],
          mass / 5 * (axes.x() * axes.x() + axes.y() * axes.y()) + density * added[2], 0.6};
}

/// Joint angles of data/scenes/three_link_swimmer.json at a time.
reference::SwimmerShape gait(double time) {
  const double rate = kTwoPi / kStroke;
  const auto sine = [&](double phase) { return std::sin(rate * time + phase); };
  const auto cosine = [&](double phase) { return rate * std::cos(rate * time + phase); };
  return {{sine(0), sine(-kTwoPi / 4)}, {cosine(0), cosine(-kTwoPi / 4)}};
}

/// Place and direction of the middle link after one stroke.
Eigen::Vector3d strokeOfScene(const std::string& time_step) {
  const Scene scene = readNamedScene(
      "three_link_swimmer", {{"duration", "2"}, {"time_step", time_step}, {"output_step", "2"}});
  const MotionSample end = runSharing(scene).motion[0].back();
  return {end.position.x(), end.position.y(),
          2 * std::atan2(end.orientation.z(), end.orientation.w())};
}

// Order 2 in the time step. Lengths are some 0.2 m.
TEST(RobotScenes, SwimmerAdvancesByItsConnection) {
  const Eigen::Vector3d expected = reference::swim(swimmerOfScene(), gait, kStroke, 400);
  const double coarse = (strokeOfScene("0.016") - expected).norm();
  const double fine = (strokeOfScene("0.008") - expected).norm();
  EXPECT_LT(coarse, 5e-4);
  EXPECT_NEAR(coarse / fine, 4, 0.3);
}

TEST(RobotScenes, ArmGoesWhereItsMotorsWant) {
  const Scene scene = readNamedScene("underwater_arm", {{"duration", "3"}});
  const std::vector<PreparedBody> bodies = prepare(scene);
  const RunRecord record = runPrepared(scene, bodies);
  const RobotDef& robot = scene.robots[0];
  std::map<std::string, double> positions;
  for (const auto& [joint, drive] : robot.motors) positions[joint] = drive.positionAt(3);
  const std::vector<RigidPose> poses = linkPoses(*robot.model, robot.pose(), positions);
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const LinkModel& link = robot.model->links[scene.bodies[i].link->link];
    const Vector3 wanted = poses[scene.bodies[i].link->link] * link.centre_of_mass;
    EXPECT_LT((record.motion[i].back().position - wanted).norm(), 0.03) << scene.bodies[i].name;
  }
}

TEST(RobotScenes, ChainTrailsBehindItsTowPoint) {
  const RunRecord record = runSharing(readNamedScene("towed_chain"));
  // The chain starts vertical, 0.24 m a link. It ends straight on a slope downstream, since all
  // links have equal weight and drag.
  const Vector3 begin = record.motion.back().front().position;
  const Vector3 end = record.motion.back().back().position;
  EXPECT_NEAR(begin.norm(), 7.5 * 0.24, 1e-12);
  EXPECT_NEAR(end.norm(), 7.5 * 0.24, 0.05);
  EXPECT_GT(end.x(), 0.5);
  EXPECT_LT(end.z(), -0.2);
  for (std::size_t i = 0; i < 8; ++i) {
    const Vector3 place = record.motion[i].back().position;
    EXPECT_LT((place - (static_cast<double>(i) + 0.5) / 7.5 * end).norm(), 0.02) << i;
  }
}

TEST(RobotScenes, TrajectoryNamesRobotAndLink) {
  const Scene scene = readNamedScene("three_link_swimmer", {{"duration", "0.04"}});
  const std::string text = makeTrajectoryText(scene, runSharing(scene).motion);
  EXPECT_NE(text.find("\n0,swimmer/middle,0,0,0,1,"), std::string::npos);
  EXPECT_NE(text.find(",swimmer/tail,"), std::string::npos);
}

/// Turn of the boat with a rudder about the vertical per second, after it has begun to drive.
double turningRate(const std::string& helm) {
  const Scene scene =
      readNamedScene("rudder_boat", {{"duration", "6"}, {"robots.0.motors.helm.position", helm}});
  return runSharing(scene).motion[0].back().twist.angular.z();
}

// A ship of length L that turns does so in circles of some L to 5 L: 0.36 m/s, 1.2 m.
TEST(RobotScenes, RudderTurnsTheBoatToItsSide) {
  const double to_left = turningRate("-0.5"), to_right = turningRate("0.5");
  EXPECT_GT(to_left, 0.36 / (5 * 1.2));
  EXPECT_LT(to_left, 0.36 / 1.2);
  EXPECT_NEAR(to_right, -to_left, 0.05 * to_left);
  EXPECT_LT(std::abs(turningRate("0")), 0.05 * to_left);
}

// The middles of links are 0.6 m from their hinges: v = v_base + w x r.
TEST(RobotScenes, MayBeginInMotion) {
  const Scene scene =
      readNamedScene("three_link_swimmer", {{"duration", "0.04"},
                                            {"robots.0.linear_velocity", "[1, 0, 0]"},
                                            {"robots.0.angular_velocity", "[0, 0, 2]"},
                                            {"robots.0.joint_positions", R"({"hip": 0})"},
                                            {"robots.0.joint_velocities", R"({"hip": 3})"}});
  const std::map<std::string, Twist> expected{
      {"swimmer/middle", {Vector3(0, 0, 2), Vector3(1, 0, 0)}},
      {"swimmer/front", {Vector3(0, 0, 2), Vector3(1, 2.4, 0)}},
      {"swimmer/tail", {Vector3(0, 0, 5), Vector3(1, -4.2, 0)}}};
  const RunRecord record = runSharing(scene);
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector6 begin = record.motion[i].front().twist.vector();
    EXPECT_LT((begin - expected.at(scene.bodies[i].name).vector()).norm(), 1e-12) << i;
  }
}

TEST(RobotScenes, ForcesActOnLinks) {
  const Scene scene = readNamedScene(
      "three_link_swimmer", {{"model", "vacuum"}, {"gravity", "[0,0,0]"}, {"time_step", "0.0005"}});
  Simulation simulation(scene, prepare(scene));
  simulation.applyForce(1, {0, 0, 100}, simulation.sample()[1].position);
  simulation.step();
  Vector3 momentum = Vector3::Zero();
  const std::vector<MotionSample> samples = simulation.sample();
  for (std::size_t i = 0; i < 3; ++i) momentum += scene.bodies[i].mass * samples[i].twist.linear;
  // Bullet turns links after pushing them: error of first order in the step.
  EXPECT_NEAR(momentum.z(), 100 * scene.time_step, 0.01 * 100 * scene.time_step);
}

// Scenes with motors, and with links at the surface of water.
TEST(RobotScenes, StatesGoOnBitForBit) {
  for (const char* name : {"three_link_swimmer", "paddle_boat"})
    expectSavedStatesGoOn(readNamedScene(name));
}

}  // namespace
}  // namespace ambient
