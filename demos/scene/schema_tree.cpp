#include "demos/scene/schema_tree.h"

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>

#include "bullet_ambient/spatial/ambient_assert.h"
#include "demos/scene/schema_text.h"
#include "preprocess/shape/shape_schema.h"

namespace ambient {
namespace {

using nlohmann::json;

SchemaNode resolveReference(const SchemaNode& from, const std::string& reference) {
  const auto hash = reference.find('#');
  const std::string name = reference.substr(0, hash);
  const json* document = name.empty() ? from.document : &schemaDocument(name);
  if (hash == std::string::npos) return {document, document};
  return {document, &document->at(json::json_pointer(reference.substr(hash + 1)))};
}

/// The node itself and everything that "$ref" and the combining keywords bring in.
std::vector<SchemaNode> expand(const SchemaNode& start) {
  std::vector<SchemaNode> nodes{start};
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const SchemaNode at = nodes[i];
    if (!at.node->is_object()) continue;
    if (at.node->contains("$ref"))
      nodes.push_back(resolveReference(at, at.node->at("$ref").get<std::string>()));
    for (const char* keyword : {"allOf", "anyOf", "oneOf"})
      if (at.node->contains(keyword))
        for (const json& branch : at.node->at(keyword)) nodes.push_back({at.document, &branch});
    for (const char* keyword : {"if", "then", "else"})
      if (at.node->contains(keyword)) nodes.push_back({at.document, &at.node->at(keyword)});
  }
  return nodes;
}

bool isIndex(const std::string& token) {
  return !token.empty() &&
         std::all_of(token.begin(), token.end(), [](unsigned char c) { return std::isdigit(c); });
}

/// The children that one flat node has for a key or an index.
void appendChildren(const SchemaNode& parent, const std::string& token,
                    std::vector<SchemaNode>& children) {
  if (!parent.node->is_object()) return;
  const auto properties = parent.node->find("properties");
  if (properties != parent.node->end() && properties->contains(token))
    children.push_back({parent.document, &properties->at(token)});
  const auto items = parent.node->find("items");
  if (items == parent.node->end() || !isIndex(token)) return;
  if (items->is_object()) children.push_back({parent.document, &*items});
  if (items->is_array() && std::stoul(token) < items->size())
    children.push_back({parent.document, &items->at(std::stoul(token))});
}

std::vector<SchemaNode> expandAll(const std::vector<SchemaNode>& nodes) {
  std::vector<SchemaNode> all;
  for (const SchemaNode& node : nodes)
    for (const SchemaNode& expanded : expand(node)) all.push_back(expanded);
  return all;
}

}  // namespace

const json& schemaDocument(const std::string& name) {
  AMBIENT_ASSERT(name == "scene.schema.json" || name == "shape.schema.json");
  static const json scene = json::parse(kSceneSchemaText);
  return name == "shape.schema.json" ? shapeSchema() : scene;
}

std::vector<SchemaNode> findSchemaNodes(const std::vector<std::string>& path) {
  const json& root = schemaDocument("scene.schema.json");
  std::vector<SchemaNode> nodes = expand({&root, &root});
  for (const std::string& token : path) {
    std::vector<SchemaNode> children;
    for (const SchemaNode& node : nodes) appendChildren(node, token, children);
    nodes = expandAll(children);
  }
  return nodes;
}

}  // namespace ambient
