#include "demos/sweep/case_file.h"

#include <nlohmann/json.hpp>
#include <sstream>

#include "bullet_ambient/base/fnv1a.h"
#include "demos/scene/scene_lookup.h"
#include "demos/scene/scene_reader.h"
#include "preprocess/builder/fluid_body_builder.h"
#include "preprocess/mesh/input_error.h"
#include "preprocess/shape/json_text.h"
#include "preprocess/shape/shape_mesh.h"

namespace ambient {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

/// Parses a case. @throws std::runtime_error unless its keys are "scene" and, optionally, "set".
json parseCase(const Case& line) {
  json parsed = parseJson(line.text, line.source);
  if (!parsed.is_object()) raiseInputError(line.source, "a case must be an object");
  for (const auto& [key, value] : parsed.items())
    if (key != "scene" && key != "set")
      raiseInputError(line.source, "unknown key \"", key, "\" in a case, which has scene and set");
  if (!parsed.contains("scene")) raiseInputError(line.source, "\"scene\" is missing");
  if (!parsed["scene"].is_string() && !parsed["scene"].is_object())
    raiseInputError(line.source, "\"scene\" must be a name, a path or a scene");
  if (parsed.contains("set") && !parsed["set"].is_object())
    raiseInputError(line.source, "\"set\" must be an object of paths and values");
  return parsed;
}

std::vector<SceneOverride> overridesIn(const json& parsed) {
  std::vector<SceneOverride> overrides;
  const auto set = parsed.find("set");
  if (set == parsed.end()) return overrides;
  for (const auto& [path, value] : set->items()) overrides.push_back({path, value.dump()});
  return overrides;
}

/// File of a scene, given by name or by a path relative to `folder`.
fs::path sceneFileOf(const std::string& scene, const fs::path& folder) {
  const fs::path found = findScene(scene, sceneFolders());
  return found == scene ? folder / found : found;
}

/// Converts integers to floating point: 8 and 8.0 get the same key.
void unifyNumbers(json& value) {
  if (value.is_number_integer()) value = value.get<double>();
  if (value.is_structured())
    for (json& part : value) unifyNumbers(part);
}

}  // namespace

std::vector<Case> readCases(const fs::path& file) {
  std::istringstream stream(readBytes(file));
  std::vector<Case> cases;
  int number = 0;
  for (std::string text; std::getline(stream, text);) {
    ++number;
    if (text.find_first_not_of(" \t\r") == std::string::npos) continue;
    cases.push_back({static_cast<int>(cases.size()), file.parent_path(),
                     file.string() + ":" + std::to_string(number), std::move(text)});
  }
  return cases;
}

std::vector<SceneOverride> overridesOf(const Case& line) { return overridesIn(parseCase(line)); }

Scene sceneOf(const Case& line) {
  const json parsed = parseCase(line);
  const json& scene = parsed["scene"];
  const std::vector<SceneOverride> overrides = overridesIn(parsed);
  if (scene.is_object())
    return parseScene(scene.dump(), line.folder / fs::path(line.source).filename(), overrides);
  try {
    return readScene(sceneFileOf(scene.get<std::string>(), line.folder), overrides);
  } catch (const std::runtime_error& error) {
    raiseInputError(line.source, error.what());
  }
}

std::string keyOf(const Scene& scene) {
  json document = json::parse(scene.text);
  for (const char* key : {"$schema", "description", "threads"}) document.erase(key);
  unifyNumbers(document);
  std::string content = libraryVersion() + "\n" + document.dump();
  for (const BodyDef& body : scene.bodies) {
    const fs::path file = fileOf(body.shape);
    if (!file.empty()) content += "\n" + std::to_string(fnv1a64(readBytes(file)));
  }
  return hashText(fnv1a64(content));
}

}  // namespace ambient
