#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace ambient {

/// One "--set PATH=VALUE". PATH is bodies.0.mass or bodies[0].mass; VALUE is JSON, else a string.
struct SceneOverride {
  std::string path;
  std::string value;
};

/// Splits at the first "=".
/// @throws std::invalid_argument if there is none or nothing stands before it.
SceneOverride parseOverride(const std::string& text);

/// Puts the value into the scene; objects on the way to a known key are made if they are missing.
/// @throws std::runtime_error if the schema does not know the path or the scene has no such array
/// element.
void applyOverride(nlohmann::json& scene, const SceneOverride& change, const std::string& file);

}  // namespace ambient
