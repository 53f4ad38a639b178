#include "preprocess/robot/robot_fluid.h"

#include <stdexcept>

#include "preprocess/mesh/input_error.h"
#include "preprocess/resistance/prepare.h"

AMBIENT_BEGIN
namespace {

AttachDef linkDef(const Robot& robot, int number, FluidBodySource& source, AttachDef def) {
  const std::optional<LinkFluid>& own = robot.link(number).fluid;
  if (own && own->medium == "water") def.medium = water();
  if (own && own->medium == "air") def.medium = air();
  if (own && own->law) def.flow.law = *own->law;
  def.fluid_body = own && !own->fluid_body.empty()
                       ? std::make_shared<const FluidBody>(readPrepared(own->fluid_body.string()))
                       : source.fluidBody(*robot.shape(number).in_link);
  def.fluid_frame = linkFluidFrame(robot, number);
  return def;
}

bool meetsFluid(const Robot& robot, int number) {
  const LinkModel& link = robot.link(number);
  const bool moves = number >= 0 || !robot.multiBody().hasFixedBase();
  return moves && !robot.shape(number).isEmpty() && (!link.fluid || link.fluid->medium != "none");
}

}  // namespace

std::vector<std::string> attachRobot(Fluid& fluid, Robot& robot, FluidBodySource& source,
                                     const AttachDef& def) {
  btMultiBody& body = robot.multiBody();
  std::vector<Immersed> links;
  std::vector<std::string> attached;
  for (int number = -1; number < body.getNumLinks(); ++number) {
    if (!meetsFluid(robot, number)) continue;
    try {
      links.push_back(fluid.add(body, number, linkDef(robot, number, source, def)));
    } catch (const std::exception& error) {
      for (Immersed& link : links) link.remove();
      raiseInputError(robot.model().source, "link \"", robot.link(number).name,
                      "\": ", error.what());
    }
    attached.push_back(robot.link(number).name);
  }
  return attached;
}

FrameOffset linkFluidFrame(const Robot& robot, int number) {
  const RigidPose& pose = robot.linkInBody(number);
  return {Matrix3(pose.linear()), Vector3(pose.translation())};
}

AMBIENT_END
