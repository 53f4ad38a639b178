// Joints of scenes: pendulums in water, the flaps of flap_in_current and the chain of
// chain_in_water.

#include <gtest/gtest.h>

#include <cmath>

#include "bullet_ambient/base/pi.h"
#include "tests/demos/scene/scene_text.h"
#include "tests/demos/simulation/scenes/run_scene.h"
#include "tests/support/refusal_of.h"

namespace ambient {
namespace {

constexpr double kStandardGravity = 9.81;
constexpr double kWater = 1000;

constexpr double kRadius = 0.05;
constexpr double kRope = 0.4;
constexpr double kMass = 3;

/// A heavy ball in water on a joint to the world, released slightly off the vertical.
nlohmann::json pendulum() {
  constexpr double kAngle = 0.01;
  nlohmann::json scene = ballScene();
  scene["duration"] = 3;
  scene["time_step"] = scene["output_step"] = 1.0 / 480;
  scene["medium"] = {{"density", kWater}};
  scene["bodies"] = {{{"name", "bob"},
                      {"shape", {{"type", "sphere"}, {"radius", kRadius}}},
                      {"mass", kMass},
                      {"position", {kRope * std::sin(kAngle), 0, -kRope * std::cos(kAngle)}}}};
  scene["joints"] = {{{"bodies", {"bob"}}, {"point", {0, 0, 0}}}};
  return scene;
}

TEST(JointScenes, RefuseAPointOutOfAllProportionToTheBody) {
  nlohmann::json scene = pendulum();
  scene["joints"][0]["point"] = {0, 1e30, 0};
  const TemporaryFolder folder;
  const std::string refusal =
      test::refusalOf<std::exception>([&] { run(readScene(writeScene(folder, scene.dump()))); });
  EXPECT_NE(refusal.find("joint of body \"bob\": its point is 1e+30 m from"), std::string::npos)
      << refusal;
}

TEST(PendulumInWater, AHingeHoldsTheBodyToItsAxis) {
  nlohmann::json hinged = pendulum();
  hinged["joints"][0]["axis"] = {0, 1, 0};
  hinged["bodies"][0]["angular_velocity"] = {1, 0, 2};
  const TemporaryFolder folder;
  const RunRecord record = run(readScene(writeScene(folder, hinged.dump())));
  for (const MotionSample& sample : record.motion[0]) {
    if (sample.time < 0.5) continue;
    EXPECT_LT(std::abs(sample.twist.angular.x()), 1e-3);
    EXPECT_LT(std::abs(sample.twist.angular.z()), 1e-3);
  }
}

/// Scene of one flap, released at an angle downstream [rad].
Scene flapAt(double angle) {
  // After a step with rows the velocity contains half of the turning part. The stall lag takes this
  // part for a spin: an error of first order, 1.3 degrees at 1/240 s.
  Scene scene = readNamedScene(
      "flap_in_current", {{"duration", "0.1"}, {"time_step", "0.0005"}, {"output_step", "0.01"}});
  scene.bodies.resize(1);
  scene.joints.resize(1);
  const double arm = std::get<Box>(scene.bodies[0].shape.geometry).half_sizes.z();
  scene.bodies[0].position = arm * Vector3(std::sin(angle), 0, -std::cos(angle));
  scene.bodies[0].orientation = Quaternion(std::cos(angle / 2), 0, -std::sin(angle / 2), 0);
  return scene;
}

/// Lifting moment less restoring moment of a flap at the angle t [N m]. Lift is by the form law on
/// the windward side, C_N = c (2 cos t - cos^2 t). Restoring: weight, and the attached share of the
/// potential flow's moment, which turns the flap across the current.
double liftingMoment(double t, const Scene& scene, const PreparedBody& body) {
  const Vector3 half = std::get<Box>(scene.bodies[0].shape.geometry).half_sizes;
  const double rho = scene.medium.density, V = scene.medium.velocity.x();
  const double arm = half.z(), area = 4 * half.y() * half.z();
  const double across = std::cos(t), z = across * across / 0.45 - 0.25;
  const double attached = 0.5 * (1 - z / std::sqrt(1 + z * z));
  const double pressure = 0.5 * rho * V * V * area * arm * 1.17 * (2 * across - across * across);
  const double weight = (body.mass - rho * body.fluid_body->volume) * kStandardGravity * arm;
  const Matrix6& added = body.fluid_body->added_mass;
  const double moment = rho * (added(3, 3) - added(5, 5)) * V * V * across;
  return pressure - (weight + attached * moment) * std::sin(t);
}

double balanceAngle(const Scene& scene, const PreparedBody& body) {
  double low = 0, high = kPi / 2;  // rises at low, falls at high
  while (high - low > 1e-9) {
    const double middle = (low + high) / 2;
    (liftingMoment(middle, scene, body) > 0 ? low : high) = middle;
  }
  return low;
}

TEST(FlapInCurrent, RisesBelowAndFallsAboveTheAngleWhereItsMomentsBalance) {
  const auto bodies = prepare(flapAt(1));
  const double balance = balanceAngle(flapAt(1), bodies[0]);
  EXPECT_NEAR(balance * 180 / kPi, 80.6, 0.1);
  constexpr double kDegree = 0.017453292519943295;
  const auto spinAfterRelease = [&](double angle) {
    return runPrepared(flapAt(angle), bodies).motion[0].back().twist.angular.y();
  };
  EXPECT_LT(spinAfterRelease(balance - kDegree), 0);
  EXPECT_GT(spinAfterRelease(balance + kDegree), 0);
}

TEST(FlapInCurrent, StreamsWhereverItIsReleased) {
  const Scene scene = readNamedScene("flap_in_current");
  const RunRecord record = runSharing(scene);
  for (const auto& motion : record.motion)
    for (const MotionSample& sample : motion) {
      if (sample.time > scene.duration / 2) {
        EXPECT_GT(sample.position.x(), 0.09);
      }
    }
}

TEST(FlapInCurrent, HangsOrStreamsByThePublishedLaw) {
  // Across the current the face has no slip, hence no pressure.
  const RunRecord record = runSharing(readNamedScene("flap_in_current", {{"law", "published"}}));
  double hanging = 0;
  for (const MotionSample& sample : record.motion[0]) hanging += sample.position.x();
  EXPECT_LT(std::abs(hanging) / static_cast<double>(record.motion[0].size()), 0.02);
  EXPECT_GT(record.motion[1].back().position.x(), 0.09);
}

/// Largest gap between the ends of neighbouring links [m].
double largestGap(const Scene& scene, const RunRecord& record) {
  const auto end = [&](std::size_t link, std::size_t row, double side) -> Vector3 {
    const MotionSample& at = record.motion[link][row];
    const Vector3 offset = side * 0.04 * Vector3::UnitX();
    const Quaternion turned = at.orientation * scene.bodies[link].orientation.conjugate();
    return at.position + turned * offset;
  };
  double gap = 0;
  for (std::size_t row = 0; row < record.motion[0].size(); ++row) {
    gap = std::max(gap, end(0, row, -1).norm());
    for (std::size_t link = 1; link < record.motion.size(); ++link)
      gap = std::max(gap, (end(link, row, -1) - end(link - 1, row, 1)).norm());
  }
  return gap;
}

TEST(ChainInWater, HoldsTogetherAndComesToHang) {
  Scene scene = readNamedScene("chain_in_water");
  scene.duration = 24;  // small swings have little drag
  const RunRecord record = runSharing(scene);
  EXPECT_LT(largestGap(scene, record), 0.002);
  double fastest = 0;
  for (const auto& motion : record.motion)
    fastest = std::max(fastest, motion.back().twist.linear.norm());
  const Vector3 last = record.motion.back().back().position;
  EXPECT_NEAR(last.norm(), 0.44, 0.002);
  EXPECT_LT(std::hypot(last.x(), last.y()), 0.1);
  EXPECT_LT(fastest, 0.15);
}

}  // namespace
}  // namespace ambient
