#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "demos/scene/scene.h"
#include "demos/scene/scene_override.h"

namespace ambient {

/// One line of a file of cases: {"scene": NAME, PATH or a whole scene, "set": {PATH: VALUE, ...}}.
struct Case {
  int index = 0;                 ///< counts the cases of the file from 0
  std::filesystem::path folder;  ///< of the file
  std::string source;            ///< "cases.jsonl:17", for messages
  std::string text;
};

/// The cases of a file, one JSON object per line; lines of blanks are passed over. The lines are
/// not parsed.
/// @throws std::runtime_error in one line if the file cannot be read.
std::vector<Case> readCases(const std::filesystem::path& file);

/// The overrides of a case, in the order of their paths; a value is JSON.
/// @throws as sceneOf().
std::vector<SceneOverride> overridesOf(const Case& line);

/// The scene of a case, checked. A path that is relative, and what a whole scene refers to, are
/// relative to the folder of the file of cases.
/// @throws std::runtime_error in one line that begins with the case's source.
Scene sceneOf(const Case& line);

/// 16 hexadecimal digits of all that a run depends on: the scene but for description, schema and
/// threads, the bytes of the files that its shapes name, and version and solver of this library.
/// @throws std::runtime_error if one of these files cannot be read.
std::string keyOf(const Scene& scene);

}  // namespace ambient
