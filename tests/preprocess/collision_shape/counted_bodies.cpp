#include <cstdio>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "preprocess/collision_shape/form_body.h"

// Makes the fluid body of a cup of many boxes under a counter of instructions.

namespace ambient {
namespace {

/// Ten walls around a floor.
ShapeForm cupOfBoxes() {
  constexpr int kWalls = 10;
  ShapeForm form{"cup", {}, 1};
  for (int i = 0; i < kWalls; ++i) {
    const double angle = 2 * kPi * i / kWalls, c = portable::cos(angle), s = portable::sin(angle);
    PlacedShape wall{Box{{0.03, 0.25, 0.5}}};
    wall.pose.linear() << c, -s, 0, s, c, 0, 0, 0, 1;
    wall.pose.translation() = Vector3(0.7 * c, 0.7 * s, 0);
    form.parts.push_back(wall);
  }
  form.parts.push_back({Box{{0.6, 0.6, 0.03}}});
  form.parts.back().pose.translation() = Vector3(0, 0, -0.45);
  return form;
}

}  // namespace
}  // namespace ambient

int main() {
  using namespace ambient;
  CollisionShapeSettings settings;
  settings.flow = {false, 300, 1};  // the flow is not the matter here
  settings.report = nullptr;
  const FluidBody body = makeFormBody(cupOfBoxes(), settings);
  std::printf("%zu faces of %zu\n", body.form_levels.front().faces.size(), body.form.faces.size());
}
