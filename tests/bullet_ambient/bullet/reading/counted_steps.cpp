#include <cstdio>
#include <cstring>
#include <memory>
#include <vector>

#include "tests/bullet_ambient/bullet/fluid_world.h"
#include "tests/support/bodies/part_bodies.h"

// Steps a small world under a counter of instructions: bodies that fly, float and rest. Its
// argument says whether the wrenches are `unread`, were read and are so no more (`stopped`), or are
// `read`.
int main(int argc, char** argv) {
  using namespace ambient;
  using namespace ambient::test;
  const char* how = argc > 1 ? argv[1] : "";
  FluidWorld scene;
  scene.world.setGravity({0, 0, bt(-9.81)});
  scene.fluid.addRegion(waterBelow(0));
  const auto shape = std::make_shared<const FluidBody>(floatingEllipsoid(kUnequalAxes, 2));
  btBoxShape box(btVector3(bt(0.2), bt(0.2), bt(0.1)));
  btBoxShape ground(btVector3(9, 9, 1));
  scene.add({0, Vector3::Ones(), startAt({0, 0, -3}), &ground});
  std::vector<Immersed> bodies;
  for (int i = 0; i < 9; ++i) {
    BodyDef def;
    def.mass = (i % 3 ? 2000 : 500) * shape->volume;
    def.moments = ellipsoidMoments(kUnequalAxes, def.mass);
    def.shape = &box;
    def.start.position = Vector3(i, 0, -i % 3);
    bodies.push_back(scene.fluid.add(scene.add(def), {shape}));
  }
  const bool is_read = std::strcmp(how, "read") == 0;
  for (const Immersed& body : bodies) {
    if (is_read || std::strcmp(how, "stopped") == 0) body.readWrench(true);
    if (!is_read) body.readWrench(false);
  }
  scene.step(1.0 / 60, 120);
  std::printf("%.9g\n", static_cast<double>(bodies.front().counters().substeps));
}
