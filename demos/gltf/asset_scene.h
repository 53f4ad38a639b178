#pragma once

#include <assimp/scene.h>

#include <memory>
#include <vector>

#include "demos/analysis/motion_sample.h"
#include "demos/scene/scene.h"
#include "demos/simulation/body_preparation.h"

namespace ambient {

/// Turns the direction against gravity into y, the axis that points up in glTF; z without gravity.
Quaternion upToY(const Vector3& gravity);

/// A run as assimp holds it: a root node that turns world axes so that y is up, below it one node
/// per body with its triangles and material, and one animation that moves those with mass. Body i
/// is node, mesh and material i; nodes are named by that number, as assimp finds them by name.
/// `motion` has the samples of each body, as RunRecord.
std::unique_ptr<aiScene> makeAssetScene(const Scene& scene, const std::vector<PreparedBody>& bodies,
                                        const std::vector<std::vector<MotionSample>>& motion);

}  // namespace ambient
