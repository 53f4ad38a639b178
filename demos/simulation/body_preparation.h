#pragma once

#include <vector>

#include "demos/scene/scene.h"
#include "demos/simulation/fluid_body_cache.h"
#include "demos/simulation/prepared_body.h"

namespace ambient {

/// The bodies of a scene, ready for the world: the fluid body of every dynamic body and the
/// collision geometry of all. Cost: the boundary element solutions that the cache does not have.
/// @throws std::runtime_error, one line that names the file or the body and what is wrong.
std::vector<PreparedBody> prepareBodies(const Scene& scene, FluidBodyCache& fluid_bodies);

}  // namespace ambient
