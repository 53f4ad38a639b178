// How an aeroplane glides, as preprocess/hand_over/glide.h says without a world, against its flight
// in one.

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "bullet_ambient/base/pi.h"
#include "preprocess/base/fluid_body_writer.h"
#include "preprocess/hand_over/glide.h"
#include "tests/demos/scene/scene_text.h"
#include "tests/demos/simulation/scenes/run_scene.h"
#include "tests/support/bodies/named_parts.h"

namespace ambient {
namespace {

constexpr double kMass = 0.45;
const Vector3 kCentre(0.02, 0, 0), kMoments(0.02, 0.03, 0.05);

nlohmann::json jsonOf(const Vector3& v) { return {v.x(), v.y(), v.z()}; }

HandedBody handed(const std::shared_ptr<const FluidBody>& shape) {
  ExportSettings settings;
  settings.medium = air();
  settings.mass = kMass;
  settings.centre_of_mass = kCentre;
  HandedBody body = handedBody(shape, settings);
  body.inertia = kMoments.asDiagonal();
  return body;
}

/// The trimmed aeroplane, quicker by a factor.
Scene thrown(const std::filesystem::path& shape, const Glide& trim, double factor) {
  nlohmann::json scene = ballScene();
  scene["duration"] = 9;
  scene["time_step"] = 1.0 / 240;
  scene["output_step"] = 1.0 / 240;
  const double up = (trim.incidence - trim.angle) / 2, speed = factor * trim.speed;
  scene["bodies"][0] = {
      {"name", "aeroplane"},
      {"shape", {{"type", "fluid_body"}, {"file", shape.string()}}},
      {"mass", kMass},
      {"centre_of_mass", jsonOf(kCentre)},
      {"inertia", {kMoments.x(), kMoments.y(), kMoments.z(), 0, 0, 0}},
      {"orientation", {std::cos(up), 0, -std::sin(up), 0}},
      {"linear_velocity", jsonOf(speed * Vector3(std::cos(trim.angle), 0, -std::sin(trim.angle)))}};
  return sceneFrom(scene);
}

/// A largest or smallest speed.
struct Extreme {
  double time = 0, change = 0;
};

std::vector<Extreme> extremesOf(const std::vector<MotionSample>& motion, double step,
                                double about) {
  std::vector<Extreme> extremes;
  const auto speed = [&](std::size_t i) { return motion[i].twist.linear.norm(); };
  for (std::size_t i = 1; i + 1 < motion.size(); ++i)
    if ((speed(i) - speed(i - 1)) * (speed(i + 1) - speed(i)) < 0)
      extremes.push_back({static_cast<double>(i) * step, speed(i) - about});
  return extremes;
}

TEST(GlideFlight, OfAnAeroplaneIsThatOfItsNumbers) {
  const auto shape =
      std::make_shared<const FluidBody>(test::built(test::PlateAeroplane().parts(), "auto"));
  const TemporaryFolder folder;
  writeFluidBody(*shape, folder / "aeroplane.ambient");
  const GlidePlan plan = planGlide(handed(shape));
  ASSERT_TRUE(plan.trim);
  const RunRecord steady = run(thrown(folder / "aeroplane.ambient", *plan.trim, 1));
  const MotionSample& end = steady.motion[0].back();
  EXPECT_NEAR(end.twist.linear.norm(), plan.trim->speed, 2e-3 * plan.trim->speed);
  EXPECT_NEAR(-end.twist.linear.x() / end.twist.linear.z(), plan.trim->ratio,
              0.01 * plan.trim->ratio);

  ASSERT_EQ(plan.stability.pitching.swings.size(), 2u);
  const Swing& phugoid = plan.stability.pitching.swings[1];
  const RunRecord pushed = run(thrown(folder / "aeroplane.ambient", *plan.trim, 1.03));
  const auto extremes = extremesOf(pushed.motion[0], 1.0 / 240, plan.trim->speed);
  ASSERT_GE(extremes.size(), 2u);
  const Extreme &a = extremes[0], &b = extremes[1];  // the short period has died out
  EXPECT_NEAR(2 * (b.time - a.time), phugoid.period, 0.01 * phugoid.period);
  const double decay = std::log(-a.change / b.change) / kPi;
  EXPECT_NEAR(decay / std::hypot(1, decay), phugoid.damping, 0.01);
}

}  // namespace
}  // namespace ambient
