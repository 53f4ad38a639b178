#pragma once

#include <string>
#include <vector>

#include "bullet_ambient/bullet/world/fluid.h"
#include "bullet_ambient/bullet/world/fluid_body_source.h"
#include "preprocess/robot/robot.h"

AMBIENT_BEGIN

/// Puts the links of a robot into a fluid, all that collide and move: with the medium, the law and
/// the fluid body that their `ambient` elements name, else those of `def` and what the source has
/// for their collision shapes.
///
///     Robot robot(withoutFixedJoints(readUrdf("rover.urdf")));
///     robot.addTo(world);
///     FluidBodyCache shapes;
///     attachRobot(fluid, robot, shapes, def);
///
/// Returns the names of the links that are in a fluid now. Remove them, or destroy the fluid,
/// before the robot.
/// @throws std::runtime_error or std::invalid_argument in one line that names the link; then none
/// of them is attached.
std::vector<std::string> attachRobot(Fluid& fluid, Robot& robot, FluidBodySource& source,
                                     const AttachDef& def);

/// The pose of a fluid body in the frame of a link of the btMultiBody, where the fluid body has the
/// axes and the origin of the URDF's link.
FrameOffset linkFluidFrame(const Robot& robot, int number);

AMBIENT_END
