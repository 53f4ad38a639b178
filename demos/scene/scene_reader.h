#pragma once

#include <filesystem>
#include <vector>

#include "demos/scene/scene.h"
#include "demos/scene/scene_override.h"

namespace ambient {

/// Reads a scene file: overrides are put in first, then the schema and all limits are checked.
/// Shape files are not opened here.
/// @throws std::runtime_error, one line that names the file, the place, the value and the limit.
Scene readScene(const std::filesystem::path& file,
                const std::vector<SceneOverride>& overrides = {});

}  // namespace ambient
