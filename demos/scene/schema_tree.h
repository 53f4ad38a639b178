#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace ambient {

/// A node of a JSON Schema and the document that its "#/..." references are relative to.
struct SchemaNode {
  const nlohmann::json* document = nullptr;
  const nlohmann::json* node = nullptr;
};

/// The scene schema or the schema of shapes that it refers to.
/// @pre `name` is "scene.schema.json" or "shape.schema.json"
const nlohmann::json& schemaDocument(const std::string& name);

/// All schema nodes that may describe the place `path` in a scene, references and alternatives
/// resolved; none if the schema does not know the place.
std::vector<SchemaNode> findSchemaNodes(const std::vector<std::string>& path);

}  // namespace ambient
