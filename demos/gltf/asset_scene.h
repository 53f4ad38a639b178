#pragma once

#include <assimp/scene.h>

#include <memory>
#include <vector>

#include "demos/analysis/motion_sample.h"
#include "demos/scene/scene.h"
#include "demos/simulation/body_preparation.h"

namespace ambient {

/// Rotation from W to glTF's axes: the direction against gravity (z without gravity) becomes y.
Quaternion upToY(const Vector3& gravity);

/// Converts a run to an assimp scene. The root node applies upToY(). Each body is a node below the
/// root, with its triangles and material; one animation moves the bodies with mass. Body i is node,
/// mesh and material i; the name of the node is i, because assimp looks nodes up by name.
/// `motion`: samples of each body, see RunRecord::motion.
std::unique_ptr<aiScene> makeAssetScene(const Scene& scene, const std::vector<PreparedBody>& bodies,
                                        const std::vector<std::vector<MotionSample>>& motion);

}  // namespace ambient
