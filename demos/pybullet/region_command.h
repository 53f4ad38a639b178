#pragma once

#include "bullet_ambient/force/medium/fluid_region.h"
#include "demos/pybullet/command.h"

namespace ambient::pybullet {

/// The region that a command `water`, `air` or `region` describes; docs/pybullet.md has the keys.
/// Does not ask for `name`. @throws std::invalid_argument with one line
FluidRegion makeRegion(Command& command);

}  // namespace ambient::pybullet
