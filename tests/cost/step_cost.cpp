// Cost of a step with a fluid over that of stock Bullet.
//
// step_cost FOLDER [PART]: times scenes whose name has the part, both worlds in turns.
// step_cost FOLDER SCENE stock|fluid|beside BODIES BEFORE STEPS: makes the steps, for callgrind,
// which counts those after the first BEFORE. step_cost FOLDER shapes: writes the shapes of the
// scenes in flight.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <functional>
#include <string>
#include <vector>

#include "tests/cost/cost_world.h"

#if __has_include(<valgrind/callgrind.h>)
#include <valgrind/callgrind.h>
#else
#define CALLGRIND_TOGGLE_COLLECT
#endif

namespace ambient::test {
namespace {

std::vector<CostScene> allScenes(const std::string& folder) {
  std::vector<CostScene> scenes = freeScenes();
  for (const auto& more : {differentScenes(), vesselScenes(), scaledScenes(), robotScenes(),
                           contactScenes(), flockScenes(folder)})
    scenes.insert(scenes.end(), more.begin(), more.end());
  return scenes;
}

double secondsFor(const std::function<void()>& action) {
  const std::clock_t begin = std::clock();
  action();
  return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

// Least time of a step of each world.
void timeScene(const CostScene& scene) {
  constexpr int kRounds = 150;
  CostWorld beside(scene.has_robots), fluid(scene.has_robots);
  (scene.fill_beside ? scene.fill_beside : scene.fill)(beside, scene.bodies);
  if (scene.fill_beside) beside.immerse();
  scene.fill(fluid, scene.bodies);
  const double attach = secondsFor([&] { fluid.immerse(); });
  double least[2] = {1e300, 1e300};
  for (int i = 0; i < scene.warm_up + kRounds; ++i) {
    const double times[2] = {secondsFor([&] { beside.step(); }), secondsFor([&] { fluid.step(); })};
    for (int k = 0; k < 2; ++k)
      if (i >= scene.warm_up) least[k] = std::min(least[k], times[k]);
  }
  std::printf("%-22s %s %.3f us, %s %+.3f us per body and step: %.2f; attach %.1f ms\n",
              scene.name.c_str(), scene.fill_beside ? "equal" : "stock",
              least[0] / scene.bodies * 1e6, scene.fill_beside ? "different" : "fluid",
              (least[1] - least[0]) / scene.bodies * 1e6, least[1] / least[0], attach * 1e3);
  std::fflush(stdout);
}

void timeScenes(const std::string& folder, const std::string& part) {
  makeFlockShapes(folder);
  for (const CostScene& scene : allScenes(folder))
    if (scene.name.find(part) != std::string::npos) timeScene(scene);
}

int makeSteps(const std::string& folder, const std::string& name, const std::string& kind,
              int bodies, int before, int steps) {
  const std::vector<CostScene> scenes = allScenes(folder);
  const auto scene = std::find_if(scenes.begin(), scenes.end(),
                                  [&](const CostScene& known) { return name == known.name; });
  const bool is_there =
      scene != scenes.end() &&
      (kind == "stock" || kind == "fluid" || (kind == "beside" && scene->fill_beside != nullptr));
  if (!is_there || bodies < 1) {
    std::fprintf(stderr, "step_cost: no scene '%s', or no world '%s'\n", name.c_str(),
                 kind.c_str());
    return EXIT_FAILURE;
  }
  CostWorld world(scene->has_robots);
  (kind == "beside" ? scene->fill_beside : scene->fill)(world, bodies);
  if (kind != "stock") world.immerse();
  for (int i = 0; i < before; ++i) world.step();
  CALLGRIND_TOGGLE_COLLECT;
  for (int i = 0; i < steps; ++i) world.step();
  CALLGRIND_TOGGLE_COLLECT;
  return EXIT_SUCCESS;
}

}  // namespace
}  // namespace ambient::test

int main(int argc, char** argv) try {
  using namespace ambient::test;
  if (argc == 7)
    return makeSteps(argv[1], argv[2], argv[3], std::atoi(argv[4]), std::atoi(argv[5]),
                     std::atoi(argv[6]));
  if (argc == 3 && std::string(argv[2]) == "shapes") {
    makeFlockShapes(argv[1]);
    return EXIT_SUCCESS;
  }
  if ((argc != 2 && argc != 3) || argv[1][0] == '-') {
    std::fprintf(
        stderr, "usage: %s FOLDER [shapes | PART | SCENE stock|fluid|beside BODIES BEFORE STEPS]\n",
        argv[0]);
    return EXIT_FAILURE;
  }
  timeScenes(argv[1], argc == 3 ? argv[2] : "");
  return EXIT_SUCCESS;
} catch (const std::exception& error) {
  std::fprintf(stderr, "step_cost: %s\n", error.what());
  return EXIT_FAILURE;
}
