// Rival models in the scenes of Padilla et al. 2025, section 5.8, with the paper's findings. Linear
// drag has no lift; windward flux turns a spinning ball to the wrong side. Both damp the tumbling
// plate to a steady fall.

#include <gtest/gtest.h>

#include <cmath>

#include "bullet_ambient/base/pi.h"
#include "demos/analysis/path_summary.h"
#include "tests/demos/scene/scene_text.h"
#include "tests/demos/simulation/scenes/run_scene.h"

namespace ambient {
namespace {

TEST(RivalScenes, LinearDragSlowsABallExponentially) {
  nlohmann::json text = ballScene();
  text["model"] = "uwrbd";
  text["linear_drag_speed"] = 2;
  text["gravity"] = {0, 0, 0};
  const TemporaryFolder folder;
  const Scene scene = readScene(writeScene(folder, text.dump()));
  const MotionSample end = runSharing(scene).motion[0].back();
  const double radius = 0.11, rho = scene.medium.density;
  const double displaced = rho * 4 / 3 * kPi * std::pow(radius, 3);
  const double rate = rho * 2 * 4 * kPi * radius * radius / (0.43 + displaced / 2);
  const double spin_rate =
      rho * 2 * 8.0 / 3 * kPi * std::pow(radius, 4) / (0.4 * 0.43 * radius * radius);
  // The mesh of 1280 flat faces has the sphere's volume and 0.2 % smaller moments of area.
  EXPECT_NEAR(end.twist.linear.x(), 30 * std::exp(-rate * end.time), 0.01);
  EXPECT_NEAR(end.twist.angular.z(), 60 * std::exp(-spin_rate * end.time), 0.05);
  // Flow between two kicks has an error of 1e-9 of the path.
  EXPECT_LE(std::abs(end.position.y()), 1e-9 * end.position.x());
}

TEST(RivalScenes, OnlyThisLibraryBendsAFreeKickToMagnusSide) {
  const Vector3 ambient = motionOf("soccer_curl", "ambient").back().position;
  const Vector3 linear = motionOf("soccer_curl", "uwrbd").back().position;
  const Vector3 flux = motionOf("soccer_curl", "gwtf").back().position;
  EXPECT_GT(ambient.y(), 4);
  EXPECT_LT(std::abs(linear.y()), 1e-3);
  EXPECT_LT(flux.y(), -0.5);
}

TEST(RivalScenes, BothDampATumblingPlateToASteadyFall) {
  for (const char* model : {"uwrbd", "gwtf"}) {
    const Scene scene = readNamedScene("plate_8cm", {{"model", model}});
    const Fall fall = analyseFall(runSharing(scene).motion[0], Vector3::UnitZ(), scene.gravity);
    EXPECT_EQ(fallingModeName(fall.mode), fallingModeName(FallingMode::kSteady)) << model;
  }
}

TEST(RivalScenes, ShortenTheFlightOfAGolfBallThatThisLibraryLengthens) {
  const auto range = [](const char* model) {
    const Scene scene = readNamedScene("golf_dimpled_spin", {{"model", model}});
    return summarisePath(runSharing(scene).motion[0], scene.gravity).landing->position.x();
  };
  const double vacuum = range("vacuum");
  EXPECT_GT(range("ambient"), 1.3 * vacuum);
  EXPECT_LT(range("uwrbd"), vacuum);
  EXPECT_LT(range("gwtf"), vacuum);
}

}  // namespace
}  // namespace ambient
