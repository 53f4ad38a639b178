// Number of faces for loads within 1 % by the form law, and time of the search:
// few_faces_study
#include <btBulletCollisionCommon.h>

#include <chrono>
#include <cstdio>
#include <exception>
#include <memory>
#include <optional>
#include <random>

#include "bullet_ambient/bullet/core/conversions.h"
#include "preprocess/base/surface_form.h"
#include "preprocess/collision_shape/collision_shape_body.h"
#include "preprocess/reduced_loads/form_levels.h"

namespace ambient {
namespace {

constexpr double kLoadError = 0.01;

std::unique_ptr<btConvexHullShape> hull(int points) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  auto shape = std::make_unique<btConvexHullShape>();
  for (int i = 0; i < points; ++i) {
    const double x = normal(random), y = normal(random), z = normal(random);
    shape->addPoint(
        toBullet(Vector3(Vector3(x, y, z).normalized().cwiseProduct(Vector3(0.5, 0.4, 0.3)))));
  }
  return shape;
}

void study(const char* name, const btCollisionShape& shape) {
  CollisionShapeSettings settings;
  settings.load_error = 0;
  settings.flow.max_panels = 0;  // faces are independent of the flow
  settings.report = nullptr;
  const FluidBody body = makeFluidBody(shape, settings);
  const auto start = std::chrono::steady_clock::now();
  const std::optional<FormLevel> level = smallestFormLevel(body, kLoadError);
  const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - start;
  const std::size_t all = formLawFaces(body, {}).size();
  if (level) {
    std::printf("| %s | %zu | %zu | %zu | %.2f | %.0f |\n", name, body.faces.size(), all,
                level->faces.size(), 100 * level->p99_error, time.count());
  } else {
    std::printf("| %s | %zu | %zu | none | | %.0f |\n", name, body.faces.size(), all, time.count());
  }
  std::fflush(stdout);
}

void run() {
  std::printf(
      "| shape | faces | with Gauss points on flat sides | few faces | error, 99th percentile [%%] "
      "| found in [ms] |\n|---|---|---|---|---|---|\n");
  study("capsule, straight part 2/3 of the diameter", btCapsuleShape(btScalar(0.3), btScalar(0.4)));
  study("capsule, 4.5", btCapsuleShape(btScalar(0.1), btScalar(0.9)));
  study("cylinder as long as wide", btCylinderShape(btVector3(0.5, 0.5, 0.5)));
  study("cylinder, 5 times", btCylinderShape(btVector3(0.1, 0.5, 0.1)));
  study("cone, height over radius 2", btConeShape(btScalar(0.5), 1));
  study("box 1 : 1 : 1", btBoxShape(btVector3(0.5, 0.5, 0.5)));
  study("box 1 : 1/2 : 1/4", btBoxShape(btVector3(0.5, 0.25, 0.125)));
  study("box 1 : 1 : 1/10", btBoxShape(btVector3(0.5, 0.5, 0.05)));
  study("hull of 40 points", *hull(40));
  study("hull of 10 points", *hull(10));
}

}  // namespace
}  // namespace ambient

int main() try {
  ambient::run();
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "few_faces_study: %s\n", error.what());
  return 1;
}
