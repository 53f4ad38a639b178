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

/// Puts the value into the scene. Creates missing objects along a path that the schema knows.
/// @throws std::runtime_error if the schema does not know the path or the scene has no such array
/// element; messages name `file`.
void applyOverride(nlohmann::json& scene, const SceneOverride& change, const std::string& file);

}  // namespace ambient
