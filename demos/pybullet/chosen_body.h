#pragma once

#include <memory>

#include "bullet_ambient/immersed/attach_def.h"
#include "demos/pybullet/command.h"

namespace ambient::pybullet {

/// Fluid body of a link that the user has chosen, with all that the command `body` says of it.
struct ChosenBody {
  std::string file;         ///< .ambient file; empty: the link's collision shape
  FrameOffset fluid_frame;  ///< F in the frame of the link's centre of mass
  double density = 0;       ///< mass of the link over its displaced volume [kg/m^3]; 0: any
  Vector3 drag{0, 0, 0};    ///< FluidBody::drag; 0: that of the file or shape
  std::string medium = "";  ///< water, air; empty: that of the region alone
  FlowSettings flow;
};

/// Reads the keys file, origin, rotation, density, drag, medium and law. `flow`: settings of all
/// bodies. @throws std::invalid_argument with one line
ChosenBody readChosenBody(Command& command, const FlowSettings& flow);

/// Returns the definition of a link. `shape`: fluid body of its collision shape, in the frame of
/// its centre of mass; used without a file. A density scales the body about its centre of volume.
/// @throws std::exception with one line
AttachDef definitionOf(const ChosenBody& chosen, std::shared_ptr<const FluidBody> shape,
                       double mass);

}  // namespace ambient::pybullet
