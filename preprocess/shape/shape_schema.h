#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace ambient {

/// data/schema/shape.schema.json as it was when the program was built.
const nlohmann::json& shapeSchema();

/// Checks one shape against the schema.
/// @throws std::runtime_error in one line that begins with `source` and names the key, the value
/// and what the schema wants.
void validateShape(const nlohmann::json& shape, const std::string& source);

}  // namespace ambient
