#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "demos/scene/scene.h"

namespace ambient {

/// Existing folders of named scenes, in order of priority: data/scenes beside the Python module;
/// ./data/scenes; the source or install tree of the running program; the source tree that the
/// program was built from.
std::vector<std::filesystem::path> sceneFolders();

/// Files of all named scenes, sorted by name; of equal names the file in the first folder.
std::vector<std::filesystem::path> listScenes(const std::vector<std::filesystem::path>& folders);

/// Returns the file of a scene, given by name or by the path of a JSON file.
/// @throws std::runtime_error with the known names if there is no such scene.
std::filesystem::path findScene(const std::string& name_or_path,
                                const std::vector<std::filesystem::path>& folders);

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
