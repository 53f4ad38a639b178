#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "demos/scene/scene.h"
#include "demos/scene/scene_override.h"

namespace ambient {

/// Reads a scene file: overrides are put in first, then the schema and all limits are checked.
/// Shape files are not opened here.
/// @throws std::runtime_error, one line that names the file, the place, the value and the limit.
Scene readScene(const std::filesystem::path& file,
                const std::vector<SceneOverride>& overrides = {});

/// The same from a text; `file` stands for it in messages, and files that it names are looked for
/// beside that. Scene::text gives the same scene again.
Scene parseScene(const std::string& text, const std::filesystem::path& file,
                 const std::vector<SceneOverride>& overrides = {});

}  // namespace ambient
