#pragma once

#include <string>
#include <vector>

#include "bullet_ambient/attach_world.h"
#include "bullet_ambient/fluid.h"
#include "preprocess/robot/robot.h"

AMBIENT_BEGIN

/// Puts all links of a robot that collide and move into a fluid: with the medium, law and fluid
/// body that their `ambient` elements name, else with those of `def` and the fluid body that the
/// source has for the collision shape.
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

/// Returns the pose of F in Bullet's body frame of a link, for a fluid body whose frame F is the
/// URDF link's frame.
FrameOffset linkFluidFrame(const Robot& robot, int number);

AMBIENT_END
