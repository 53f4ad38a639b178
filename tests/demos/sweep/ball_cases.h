#pragma once

#include "tests/demos/scene/scene_text.h"

namespace ambient {

/// A small ball in flight for a tenth of a second; quick to prepare and to run.
inline nlohmann::json shortFlight() {
  nlohmann::json scene = ballScene();
  scene["bodies"][0]["shape"]["faces"] = 80;
  scene["duration"] = 0.1;
  return scene;
}

inline std::string caseLine(const nlohmann::json& scene, const nlohmann::json& set) {
  return nlohmann::json{{"scene", scene}, {"set", set}}.dump() + "\n";
}

/// Writes cases with balls of several masses [kg].
inline std::filesystem::path writeMasses(const TemporaryFolder& folder,
                                         const std::vector<double>& masses) {
  std::string text;
  for (const double mass : masses) text += caseLine(shortFlight(), {{"bodies.0.mass", mass}});
  const std::filesystem::path file = folder / "cases.jsonl";
  writeText(file, text);
  return file;
}

}  // namespace ambient
