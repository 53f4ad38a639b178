#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "demos/scene/scene.h"
#include "demos/scene/scene_override.h"

namespace ambient {

/// One line of a file of cases: {"scene": NAME, PATH or whole scene, "set": {PATH: VALUE, ...}}.
struct Case {
  int index = 0;                 ///< index of the case in the file, from 0
  std::filesystem::path folder;  ///< folder of the file
  std::string source;            ///< "cases.jsonl:17", for messages
  std::string text;
};

/// Reads a file of cases, one JSON object per line; skips blank lines. Does not parse the
/// lines.
/// @throws std::runtime_error in one line if the file cannot be read.
std::vector<Case> readCases(const std::filesystem::path& file);

/// Overrides of a case, sorted by path; values are JSON.
/// @throws std::runtime_error as sceneOf().
std::vector<SceneOverride> overridesOf(const Case& line);

/// Reads and checks the scene of a case. Relative paths, in `scene` and within a whole scene, are
/// relative to Case::folder.
/// @throws std::runtime_error in one line that begins with the case's source.
Scene sceneOf(const Case& line);

/// Key of a run's result, 16 hexadecimal digits: hash of the scene without description, schema and
/// threads, of the files that its shapes name, and of version and solver of this library.
/// @throws std::runtime_error if one of these files cannot be read.
std::string keyOf(const Scene& scene);

}  // namespace ambient
