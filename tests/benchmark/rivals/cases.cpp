#include "tests/benchmark/rivals/cases.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/reference/ellipsoid_added_mass.h"

namespace ambient::rivals {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

int stepsIn(double duration, const Scene& scene) {
  return static_cast<int>(std::lround(duration / scene.step));
}

Scene sceneOf(const Solid& solid, const Motion& start) {
  Scene scene;
  scene.solid = solid;
  scene.starts = {start};
  return scene;
}

// (rho - rho_B) g / (rho_B + rho / 2) = 1.5 g: the ball has half of its volume of water as added
// mass. Its drag has not begun after a millisecond.
AccuracyCase lightBall() {
  Motion start;
  start.position = {0, 0, -50};
  AccuracyCase c{"light ball",
                 "m/s^2",
                 "closed form",
                 1.5 * kGravity,
                 sceneOf({Form::kBall, {0.1, 0, 0}, 0.1 * kWaterDensity}, start),
                 {}};
  c.scene.step = 1e-3;
  c.measure = [](World& world, const Scene& scene) {
    world.step();
    return world.motion(0).velocity[2] / scene.step;
  };
  return c;
}

/// Time from one passage downward through `balance` to the next [s].
double periodOf(World& world, const Scene& scene, double balance) {
  double first = kNone, before = scene.starts.front().position[2];
  for (int i = 1; i <= stepsIn(10, scene); ++i) {
    world.step();
    const double now = world.motion(0).position[2];
    if (before > balance && now <= balance) {
      const double passage = (i - (balance - now) / (before - now)) * scene.step;
      if (std::isfinite(first)) return passage - first;
      first = passage;
    }
    before = now;
  }
  return kNone;
}

// A box of the breadth, length and mass of the section of a ship of docs/reality_at_sea.md, ten
// breadths long, let go 2 cm above its balance.
AccuracyCase barge() {
  constexpr Triple kHalf{2, 0.2, 0.125};
  constexpr double kMass = 314.4;  // [kg]
  const double draught = kMass / (kWaterDensity * 4 * kHalf[0] * kHalf[1]);
  const double balance = kHalf[2] - draught;
  Motion start;
  start.position = {0, 0, balance + 0.02};
  Solid solid{Form::kBox, kHalf, 1};
  solid.density = kMass / volumeOf(solid);
  AccuracyCase c{"barge in heave",      "s", "measured, Sundsdal et al. 2025", 1.17,
                 sceneOf(solid, start), {}};
  c.scene.has_surface = true;
  c.measure = [balance](World& world, const Scene& scene) {
    return periodOf(world, scene, balance);
  };
  return c;
}

// sqrt(2 (rho - rho_B) g a / (rho C_D)), released 3 degrees off level.
AccuracyCase risingCube() {
  constexpr double kEdge = 0.2, kPart = 0.6, kDrag = 1.05;
  Motion start;
  start.position = {0, 0, -50};
  start.rotation = {0.99965732, 0.02617695, 0, 0};
  AccuracyCase c{
      "rising cube",
      "m/s",
      "measured C_D 1.05",
      std::sqrt(2 * (1 - kPart) * kGravity * kEdge / kDrag),
      sceneOf({Form::kBox, {kEdge / 2, kEdge / 2, kEdge / 2}, kPart * kWaterDensity}, start),
      {}};
  c.measure = [](World& world, const Scene& scene) {
    const int half = stepsIn(5, scene);
    for (int i = 0; i < half; ++i) world.step();
    const double before = world.motion(0).position[2];
    for (int i = 0; i < half; ++i) world.step();
    return (world.motion(0).position[2] - before) / (half * scene.step);
  };
  return c;
}

// The largest change of the energy of body and flow, over the energy. It is conserved.
AccuracyCase tumblingEllipsoid() {
  Motion start;
  start.position = {0, 0, -50};
  start.velocity = {0.6, 0.5, 0.4};
  start.spin = {0.5, 1, -0.5};
  AccuracyCase c{"ellipsoid in ideal flow",
                 "1",
                 "conserved",
                 0,
                 sceneOf({Form::kEllipsoid, {0.5, 0.3, 0.2}, kWaterDensity}, start),
                 {}};
  c.scene.is_ideal = true;
  c.measure = [](World& world, const Scene& scene) {
    const double begin = energyInIdealFlow(scene.solid, scene.starts.front());
    double worst = 0;
    for (int i = 0; i < stepsIn(20, scene); ++i) {
      world.step();
      worst =
          std::max(worst, std::abs(energyInIdealFlow(scene.solid, world.motion(0)) / begin - 1));
    }
    return worst;
  };
  return c;
}

}  // namespace

std::vector<AccuracyCase> accuracyCases() {
  return {lightBall(), barge(), risingCube(), tumblingEllipsoid()};
}

double energyInIdealFlow(const Solid& ellipsoid, const Motion& motion) {
  using Eigen::Vector3d;
  const auto& [w, x, y, z] = motion.rotation;
  const Eigen::Quaterniond to_body = Eigen::Quaterniond(w, x, y, z).normalized().conjugate();
  const Vector3d spin = to_body * Vector3d(motion.spin.data());
  const Vector3d velocity = to_body * Vector3d(motion.velocity.data());
  const Eigen::Matrix<double, 6, 1> fluid =
      kWaterDensity * reference::ellipsoidAddedMass(Vector3d(ellipsoid.size.data()));
  const Triple moments = ellipsoidMoments(ellipsoid);
  const Vector3d angular = Vector3d(moments.data()) + fluid.head<3>();
  const Vector3d linear = fluid.tail<3>().array() + ellipsoid.density * volumeOf(ellipsoid);
  return (angular.dot(spin.cwiseAbs2()) + linear.dot(velocity.cwiseAbs2())) / 2;
}

namespace {

constexpr Triple kBox{0.5, 0.3, 0.4};
constexpr Triple kCapsule{0.2, 0.3, 0};
constexpr double kPitch = 6;  // of crowds [m]

/// Unit quaternion, turned by the small angle about (1, 0.3, 0.2).
std::array<double, 4> tilt(double angle) {
  std::array<double, 4> q{1, 0.5 * angle, 0.15 * angle, 0.1 * angle};
  const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  for (double& part : q) part /= length;
  return q;
}

/// Bodies in rows, a little turned, at rest.
Scene rowsOf(const Solid& solid, int count, bool has_surface) {
  Scene scene;
  scene.solid = solid;
  scene.has_surface = has_surface;
  Motion start;
  start.position[2] = has_surface ? 0 : -50;
  scene.starts = {start};
  scene = crowdOf(scene, count);
  for (int i = 0; i < count; ++i) {
    if (has_surface) scene.starts[i].position[2] += 0.01 * (i % 7);
    scene.starts[i].rotation = tilt(0.1 + 0.01 * (i % 11));
  }
  return scene;
}

/// A cube of boxes on a floor between four walls, all under water.
Scene pileOf(int edge) {
  constexpr double kHalf = 0.1, kGap = 0.005;
  Scene scene;
  scene.solid = {Form::kBox, {kHalf, kHalf, kHalf}, 2500};
  scene.step = 1.0 / 240;
  scene.room = (1.5 * edge + 2) * kHalf;
  for (int i = 0; i < edge * edge * edge; ++i) {
    const int place[3] = {i % edge, i / edge % edge, i / (edge * edge)};
    Motion start;
    for (int k = 0; k < 3; ++k)
      start.position[k] = (place[k] - (k < 2 ? (edge - 1) / 2.0 : -0.5)) * (2 * kHalf + kGap);
    start.rotation = tilt(0.002 * (i % 5 - 2));
    scene.starts.push_back(start);
  }
  return scene;
}

}  // namespace

Scene crowdOf(const Scene& scene, int count) {
  Scene crowd = scene;
  crowd.step = 1.0 / 60;
  crowd.starts.assign(count, scene.starts.front());
  for (int i = 0; i < count; ++i) {
    crowd.starts[i].position[0] += kPitch * (i % 32 - 15.5);
    crowd.starts[i].position[1] += kPitch * (i / 32 - 15.5);
  }
  return crowd;
}

std::vector<CostCase> costCases(int count, int edge) {
  const Solid box{Form::kBox, kBox, 1000}, capsule{Form::kCapsule, kCapsule, 1000},
      light{Form::kBox, kBox, 500};
  return {{"boxes under water", rowsOf(box, count, false)},
          {"capsules under water", rowsOf(capsule, count, false)},
          {"boxes afloat", rowsOf(light, count, true)},
          {"pile of " + std::to_string(edge * edge * edge) + " boxes", pileOf(edge), 240}};
}

}  // namespace ambient::rivals
