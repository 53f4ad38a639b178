#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "demos/analysis/motion_sample.h"
#include "demos/scene/scene.h"
#include "demos/simulation/body_preparation.h"

namespace ambient {

/// Whether a file's name ends in .glb or .gltf.
bool isGltfName(const std::filesystem::path& file);

/// The bytes of an animated glTF 2.0 of a run, in one piece: the binary container if the name ends
/// in .glb, else JSON that holds its buffer. Metres and seconds, y up; one node per body, named as
/// in the scene. `motion` has the samples of each body, as RunRecord.
/// @throws std::runtime_error if the exporter fails.
std::string makeGltf(const std::filesystem::path& file, const Scene& scene,
                     const std::vector<PreparedBody>& bodies,
                     const std::vector<std::vector<MotionSample>>& motion);

}  // namespace ambient
