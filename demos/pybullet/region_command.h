#pragma once

#include "bullet_ambient/force/medium/fluid_region.h"
#include "demos/pybullet/command.h"

namespace ambient::pybullet {

/// Returns the region that a command `water`, `air` or `region` describes; docs/pybullet.md lists
/// the keys. @pre the key `name` was read, so that finish() knows it. @throws std::invalid_argument
/// with one line
FluidRegion makeRegion(Command& command);

}  // namespace ambient::pybullet
