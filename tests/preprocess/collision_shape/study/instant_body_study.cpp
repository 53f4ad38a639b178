// Cost and error of Quality::kInstant over 200 random shapes: instant_body_study
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <vector>

#include "bullet_ambient/spatial/inertia.h"
#include "preprocess/collision_shape/collision_shape_body.h"
#include "tests/preprocess/collision_shape/study/random_shapes.h"

namespace ambient {
namespace {

double errorOf(const Matrix3& block, const Matrix3& reference) {
  return (block - reference).cwiseAbs().maxCoeff() / reference.cwiseAbs().maxCoeff();
}

/// Times and errors for one kind of shapes.
struct Results {
  std::vector<double> milliseconds, translation, rotation;

  void add(const btCollisionShape& shape) {
    CollisionShapeSettings settings;
    settings.report = nullptr;
    settings.load_error = 0;  // measures added mass, not faces
    settings.faces = kInstantFaces;
    // Error of some per cent, against tens for the guess. Prisms have fewer triangles: divided.
    settings.flow.max_panels = kInstantFaces;
    const FluidBody solved = makeFluidBody(shape, settings);
    settings.quality = Quality::kInstant;
    const auto start = std::chrono::steady_clock::now();
    const FluidBody guess = makeFluidBody(shape, settings);
    const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - start;
    const Matrix6 K = shiftOrigin(guess.added_mass, solved.centre_of_volume);
    const Matrix6 reference = shiftOrigin(solved.added_mass, solved.centre_of_volume);
    milliseconds.push_back(time.count());
    rotation.push_back(errorOf(K.topLeftCorner<3, 3>(), reference.topLeftCorner<3, 3>()));
    translation.push_back(
        errorOf(K.bottomRightCorner<3, 3>(), reference.bottomRightCorner<3, 3>()));
  }

  static double share(std::vector<double> values, double share) {
    std::sort(values.begin(), values.end());
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
  }
  void print(const char* kind) const {
    std::printf("| %s | %zu | %.1f | %.1f | %.0f | %.0f | %.0f | %.0f |\n", kind,
                translation.size(), share(milliseconds, 0.5), share(milliseconds, 0.9),
                100 * share(translation, 0.5), 100 * share(translation, 0.9),
                100 * share(rotation, 0.5), 100 * share(rotation, 0.9));
    std::fflush(stdout);
  }
};

void run() {
  std::printf(
      "| shapes | number | time [ms] | 90 %% | translation off by [%%] | 90 %% | rotation off by "
      "[%%] | "
      "90 %% |\n|---|---|---|---|---|---|---|---|\n");
  Results hulls, compounds, meshes;
  for (unsigned seed = 0; seed < 40; ++seed) meshes.add(RandomShapes(seed).prism());
  meshes.print("prisms over stars, as meshes");
  for (unsigned seed = 0; seed < 80; ++seed) hulls.add(RandomShapes(seed).hull());
  hulls.print("convex hulls of 6 to 30 points");
  for (unsigned seed = 0; seed < 80; ++seed) compounds.add(RandomShapes(seed).compound());
  compounds.print("compounds of 2 to 5");
}

}  // namespace
}  // namespace ambient

int main() try {
  ambient::run();
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "instant_body_study: %s\n", error.what());
  return 1;
}
