#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "demos/analysis/motion_sample.h"
#include "demos/scene/scene.h"
#include "demos/simulation/body_preparation.h"

namespace ambient {

/// True if a file's name ends in .glb or .gltf.
bool isGltfName(const std::filesystem::path& file);

/// Bytes of a self-contained, animated glTF 2.0 file of a run: a binary container if the name ends
/// in .glb, else JSON with embedded buffer. Metres and seconds, y up; one node per body, named as
/// in the scene. `motion`: samples of each body, see RunRecord::motion.
/// @throws std::runtime_error if the exporter fails.
std::string makeGltf(const std::filesystem::path& file, const Scene& scene,
                     const std::vector<PreparedBody>& bodies,
                     const std::vector<std::vector<MotionSample>>& motion);

}  // namespace ambient
