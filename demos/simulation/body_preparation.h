#pragma once

#include <vector>

#include "demos/scene/scene.h"
#include "demos/simulation/prepared_body.h"
#include "demos/simulation/scene_body_cache.h"

namespace ambient {

/// Prepares the bodies of a scene, in order: the fluid body of each dynamic body, surface and mass
/// of all bodies. Cost: one boundary element solution per shape that the cache does not hold.
/// @throws std::runtime_error, one line that names the file or the body and what is wrong.
std::vector<PreparedBody> prepareBodies(const Scene& scene, SceneBodyCache& fluid_bodies);

/// Returns a surface moved by a vector [m].
Surface moved(Surface surface, const Vector3& by);

}  // namespace ambient
