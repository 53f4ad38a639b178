#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/force/loads/surface_loads.h"
#include "demos/analysis/path_summary.h"
#include "demos/rivals/rival_laws.h"
#include "tests/demos/scene/scene_text.h"
#include "tests/demos/simulation/scenes/run_scene.h"
#include "tests/support/bodies/ellipsoid_body.h"

namespace ambient {
namespace {

// Rival models in the scenes of Padilla et al. 2025, section 5.8, with the paper's findings. Linear
// drag has no lift; windward flux turns a spinning ball to the wrong side. Both damp the tumbling
// plate to a steady fall.

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

// Load laws of the models compared in the demos, on a sphere.

constexpr double kBallRadius = 0.11;
constexpr double kDensity = 1.204;

Wrench loadOnBall(const LoadLaw& law, const Twist& twist) {
  LoadSettings settings;
  settings.density = kDensity;
  const auto ball = std::make_shared<const FluidBody>(test::gaussSphere(kBallRadius));
  return law(ball, settings)->load(twist);
}

TEST(LinearDrag, OfASphereIsForceByVelocityAndTorqueBySpin) {
  const double drag_speed = 0.7;
  const Twist twist{{5, -3, 60}, {30, 4, -2}};
  const Wrench load = loadOnBall(linearDrag(drag_speed), twist);
  const double area = 4 * kPi * kBallRadius * kBallRadius;
  const Vector3 force = -kDensity * drag_speed * area * twist.linear;
  const Vector3 torque =
      -2.0 / 3 * kDensity * drag_speed * area * kBallRadius * kBallRadius * twist.angular;
  EXPECT_LE((load.force - force).norm(), 1e-12 * force.norm());
  EXPECT_LE((load.torque - torque).norm(), 1e-12 * torque.norm());
}

TEST(LinearDrag, RefusesASpeedThatIsNotPositive) {
  for (const double speed : {0.0, -1.0, std::nan("")})
    EXPECT_THROW(linearDrag(speed), std::invalid_argument);
}

TEST(WindwardFlux, OfASphereHasDragOneAndASideForceAgainstMagnus) {
  // With v along z the faces' rule integrates the windward half exactly.
  const double speed = 30, spin = 60;
  const Twist twist{{spin, 0, 0}, {0, 0, speed}};
  const Wrench load = loadOnBall(windwardFlux(), twist);
  const double drag = 0.5 * kDensity * speed * speed * kPi * kBallRadius * kBallRadius;
  const double side = kPi / 3 * kDensity * std::pow(kBallRadius, 3) * speed * spin;
  // Magnus' force is along w x v = -y.
  EXPECT_LE((load.force - Vector3(0, side, -drag)).norm(), 1e-12 * drag);
  const double torque = -3.0 / 8 * kPi * kDensity * speed * std::pow(kBallRadius, 4) * spin;
  EXPECT_LE((load.torque - Vector3(torque, 0, 0)).norm(), 1e-12 * std::abs(torque));
}

TEST(WindwardFlux, TakesPowerFromEveryMotion) {
  for (const Twist& twist : {Twist{{1, 2, 3}, {0, 0, 0}}, Twist{{-40, 5, 90}, {3, -7, 1}},
                             Twist{{0, 0, 0}, {0.1, 0.2, 0.3}}})
    EXPECT_LE(power(loadOnBall(windwardFlux(), twist), twist), 0);
}

}  // namespace
}  // namespace ambient
