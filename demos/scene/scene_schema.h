#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace ambient {

/// Checks a scene against data/schema/scene.schema.json, which is part of the program.
/// @throws std::runtime_error that names `file`, the place, the value and what the schema wants.
void validateAgainstSchema(const nlohmann::json& scene, const std::string& file);

/// Whether the schema knows a place in a scene, such as {"bodies", "0", "mass"}. Any index is known
/// in an array.
bool schemaKnows(const std::vector<std::string>& path);

/// "bodies[0].mass" for {"bodies", "0", "mass"}.
std::string placeName(const std::vector<std::string>& path);

}  // namespace ambient
