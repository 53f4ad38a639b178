#include "demos/pybullet/chosen_body.h"

#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/fluid_body.h"
#include "bullet_ambient/spatial/rotation.h"
#include "preprocess/polar/frontal_area.h"

namespace ambient::pybullet {
namespace {

Matrix3 readRotation(Command& command) {
  if (!command.has("rotation")) return Matrix3::Identity();
  const std::vector<double> q = command.numbers("rotation", 4, 4);
  const Quaternion rotation(q[3], q[0], q[1], q[2]);
  if (!(rotation.norm() > 0)) command.fail("rotation is x,y,z,w of a quaternion, not all 0");
  return rotation.normalized().toRotationMatrix();
}

// Scales a body to a volume about its centre of volume.
void scaleTo(double volume, FluidBody& body, FrameOffset& frame) {
  if (!(body.volume > 0))
    throw std::invalid_argument("body: '" + body.name +
                                "' has no volume, so that it cannot have a density");
  const double factor = portable::cbrt(volume / body.volume);
  frame.translation += (1 - factor) * (frame.rotation * body.centre_of_volume);
  body = scaled(body, factor);
}

}  // namespace

ChosenBody readChosenBody(Command& command, const FlowSettings& flow) {
  ChosenBody chosen;
  chosen.flow = flow;
  chosen.file = command.text("file", "");
  chosen.fluid_frame = {readRotation(command), command.vector("origin", Vector3::Zero())};
  if (chosen.file.empty() && !chosen.fluid_frame.isIdentity())
    command.fail("origin and rotation are those of a file");
  chosen.density = command.number("density", 0);
  if (command.has("density") && !(chosen.density > 0)) command.fail("density must be > 0");
  chosen.drag = command.vector("drag", Vector3::Zero());
  if (command.has("drag") &&
      !(chosen.drag.minCoeff() > 0 && chosen.drag.maxCoeff() <= kLargestDrag))
    command.fail("drag has three numbers > 0, at most 1e6");
  chosen.medium = command.text("medium", "");
  if (!chosen.medium.empty() && chosen.medium != "water" && chosen.medium != "air")
    command.fail("medium is one of: water, air");
  chosen.flow.law = command.choose("law", kPressureLawNames, flow.law);
  return chosen;
}

AttachDef definitionOf(const ChosenBody& chosen, std::shared_ptr<const FluidBody> shape,
                       double mass) {
  AttachDef def;
  def.flow = chosen.flow;
  def.fluid_frame = chosen.fluid_frame;
  if (chosen.medium == "water") def.medium = water();
  if (chosen.medium == "air") def.medium = air();
  def.fluid_body = chosen.file.empty() ? std::move(shape) : loadFluidBody(chosen.file);
  if (chosen.density == 0 && chosen.drag.isZero(0)) return def;
  FluidBody own = *def.fluid_body;
  if (chosen.density > 0) scaleTo(mass / chosen.density, own, def.fluid_frame);
  if (!chosen.drag.isZero(0)) setMeasuredDrag(chosen.drag, own);
  def.fluid_body = std::make_shared<const FluidBody>(std::move(own));
  return def;
}

}  // namespace ambient::pybullet
