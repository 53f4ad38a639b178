#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "demos/scene/scene.h"
#include "demos/scene/scene_override.h"

namespace ambient {

/// Reads a scene file: applies the overrides, then checks the schema and all limits. Does not open
/// shape files.
/// @throws std::runtime_error, one line that names the file, the place, the value and the limit.
Scene readScene(const std::filesystem::path& file,
                const std::vector<SceneOverride>& overrides = {});

/// Like readScene(), but from a JSON text. Messages name `file`; relative paths in the scene are
/// relative to the folder of `file`. Parsing Scene::text gives the same scene.
Scene parseScene(const std::string& text, const std::filesystem::path& file,
                 const std::vector<SceneOverride>& overrides = {});

}  // namespace ambient
