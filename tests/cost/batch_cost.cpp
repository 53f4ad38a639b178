// Cost of a step of a world in a batch, whose vehicles have six thrusters and sensors.
//
// batch_cost FOLDER SCENE together|alone WORLDS BEFORE STEPS [rigid|afloat]: makes env steps of
// four steps each, on one thread, for callgrind, which counts those after the first BEFORE. FOLDER
// keeps the fluid bodies. rigid: the robot of the scene, of one link, is a rigid body. afloat: the
// level of the water is at the origin.

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <string>

#include "demos/scene/scene_reader.h"
#include "demos/simulation/body_preparation.h"
#include "demos/worlds/world_batch.h"
#include "preprocess/base/fluid_body_writer.h"

#if __has_include(<valgrind/callgrind.h>)
#include <valgrind/callgrind.h>
#else
#define CALLGRIND_TOGGLE_COLLECT
#endif

namespace ambient::test {
namespace {

/// Replaces the robot, which has one link, by a rigid body of the same mass and fluid body.
void makeRigid(Scene& scene, const std::filesystem::path& folder) {
  SceneBodyCache cache(folder);
  const PreparedBody link = prepareBodies(scene, cache).front();
  cache.save();
  const std::filesystem::path file = folder / (scene.name + "_rigid.ambient");
  writeFluidBody(*link.fluid_body, file);
  BodyDef& body = scene.bodies.front();
  body.link.reset();
  body.shape.geometry = FluidBodyFile{file};
  body.inertia = link.inertia;
  body.centre_of_mass = link.centre_of_mass;
  scene.robots.clear();
}

/// Puts the level of the water to the origin, and air above it.
void putAfloat(Scene& scene) {
  scene.water.emplace();
  scene.medium = air();
  for (BodyDef& body : scene.bodies) body.attach.medium = air();
}

void makeSteps(int count, char** arguments) {
  Scene scene = readScene(findScene(arguments[2], sceneFolders()));
  const std::filesystem::path folder = arguments[1];
  const std::string change = count > 7 ? arguments[7] : "";
  if (change == "rigid") makeRigid(scene, folder);
  if (change == "afloat") putAfloat(scene);
  BatchSettings settings;
  settings.fluid_bodies = folder;
  settings.together = std::string(arguments[3]) == "alone" ? 1 : 8;
  settings.worlds = std::atoi(arguments[4]);
  settings.substeps = 4;
  settings.threads = 1;
  if (!scene.thrusters.empty()) settings.actions = {{"thrusters"}};
  settings.observations = {{"position"}, {"rotation"}, {"twist"}};
  settings.variations = {{"position", "", {-1}, {1}}};
  WorldBatch batch(scene, settings);
  for (int i = 0; i < batch.worlds() * batch.plan().action_size; ++i)
    batch.actions()[i] = 0.1 * (i % 7 - 3);
  for (int n = std::atoi(arguments[5]); n > 0; --n) batch.step();
  CALLGRIND_TOGGLE_COLLECT;
  for (int n = std::atoi(arguments[6]); n > 0; --n) batch.step();
  CALLGRIND_TOGGLE_COLLECT;
}

}  // namespace
}  // namespace ambient::test

int main(int count, char** arguments) {
  if (count < 7 || count > 8) {
    std::fprintf(stderr,
                 "batch_cost FOLDER SCENE together|alone WORLDS BEFORE STEPS [rigid|afloat]\n");
    return 2;
  }
  try {
    ambient::test::makeSteps(count, arguments);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "batch_cost: %s\n", error.what());
    return 1;
  }
  return 0;
}
