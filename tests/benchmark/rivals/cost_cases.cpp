#include <cmath>

#include "tests/benchmark/rivals/cases.h"

namespace ambient::rivals {
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
