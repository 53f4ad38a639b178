#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "demos/scene/scene.h"

namespace ambient {

/// One option "--set PATH=VALUE". PATH: bodies.0.mass or bodies[0].mass; VALUE: JSON, or a string.
struct SceneOverride {
  std::string path;
  std::string value;
};

/// Splits PATH=VALUE at the first "=".
/// @throws std::invalid_argument if there is no "=" or the path is empty.
SceneOverride parseOverride(const std::string& text);

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
