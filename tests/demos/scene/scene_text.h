#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "demos/scene/scene_reader.h"
#include "tests/support/temporary_folder.h"

namespace ambient {

/// A small valid scene: one ball in air.
inline nlohmann::json ballScene() {
  return nlohmann::json::parse(R"({
    "duration": 2, "time_step": 0.01, "output_step": 0.05, "gravity": [0, 0, -9.81],
    "medium": {"density": 1.204, "viscosity": 1.82e-5, "velocity": [0, 0, 0]},
    "model": "ambient",
    "bodies": [{"name": "ball", "shape": {"type": "sphere", "radius": 0.11}, "mass": 0.43,
                "position": [0, 0, 1], "orientation": [1, 0, 0, 0],
                "linear_velocity": [30, 0, 0], "angular_velocity": [0, 0, 60],
                "separation_angle": 1.5707963267948966, "skin_friction": true}]})");
}

inline std::filesystem::path writeScene(const TemporaryFolder& folder, const std::string& text,
                                        const std::string& name = "ball.json") {
  const std::filesystem::path file = folder / name;
  writeText(file, text);
  return file;
}

inline Scene sceneFrom(const nlohmann::json& text) {
  const TemporaryFolder folder;
  return readScene(writeScene(folder, text.dump()));
}

/// Returns the complaint of reading the scene, without the file's name; "" if there is none.
inline std::string complaintAbout(const nlohmann::json& scene,
                                  const std::vector<SceneOverride>& overrides = {}) {
  const TemporaryFolder folder;
  const std::filesystem::path file = writeScene(folder, scene.dump());
  try {
    readScene(file, overrides);
  } catch (const std::exception& error) {
    const std::string text = error.what();
    const std::string start = file.string() + ": ";
    return text.compare(0, start.size(), start) == 0 ? text.substr(start.size())
                                                     : "names another file: " + text;
  }
  return "";
}

}  // namespace ambient
