#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace ambient {

/// One option "--set PATH=VALUE". PATH: bodies.0.mass or bodies[0].mass; VALUE: JSON, or a string.
struct SceneOverride {
  std::string path;
  std::string value;
};

/// Splits PATH=VALUE at the first "=".
/// @throws std::invalid_argument if there is no "=" or the path is empty.
SceneOverride parseOverride(const std::string& text);

/// Puts the value into the scene. Creates missing objects along the path; a key that the schema
/// does not know is refused when the scene is checked.
/// @throws std::runtime_error if the scene has no such array element, or something else than an
/// object on the way; messages name `file`.
void applyOverride(nlohmann::json& scene, const SceneOverride& change, const std::string& file);

}  // namespace ambient
