#pragma once

#include "bullet_ambient/ambient.h"
#include "tests/support/world.h"

namespace ambient {

/// A world for robots and its fluid.
struct FluidRobotWorld : test::TreeWorld {
  Fluid fluid{world};
};

}  // namespace ambient
