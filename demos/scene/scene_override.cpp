#include "demos/scene/scene_override.h"

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <vector>

#include "demos/scene/scene_schema.h"
#include "preprocess/mesh/input_error.h"
#include "preprocess/shape/json_text.h"

namespace ambient {
namespace {

using nlohmann::json;

/// Splits bodies.0.mass or bodies[0].mass into {"bodies", "0", "mass"}; keeps empty tokens.
std::vector<std::string> splitPath(const std::string& path) {
  std::vector<std::string> tokens(1);
  for (const char c : path) {
    if (c == '.' || c == '[')
      tokens.emplace_back();
    else if (c != ']')
      tokens.back() += c;
  }
  return tokens;
}

/// Parses a value; a text that is not JSON becomes a string, which must be UTF-8.
json parseValue(const std::string& text, const std::string& source) {
  if (json::accept(text)) return parseJson(text, source);
  json value(text);
  try {
    static_cast<void>(value.dump());
  } catch (const json::type_error&) {
    raiseInputError(source, "the value is not valid UTF-8");
  }
  return value;
}

/// Returns the element or member of `parent` named by `token`; creates a missing member.
json& descend(json& parent, const std::string& token, const std::string& parent_name) {
  if (parent.is_array()) {
    if (!isIndex(token) || std::stoul(token) >= parent.size())
      throw std::out_of_range(parent_name + " has " + std::to_string(parent.size()) +
                              " elements, no element " + token);
    return parent[std::stoul(token)];
  }
  if (parent.is_null()) parent = json::object();
  if (!parent.is_object() || isIndex(token))
    throw std::out_of_range(parent_name + " is " + (parent.empty() ? "not given" : parent.dump()) +
                            " and has no part " + token);
  return parent[token];
}

}  // namespace

SceneOverride parseOverride(const std::string& text) {
  const auto equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    throw std::invalid_argument("--set " + text + ": must be PATH=VALUE");
  return {text.substr(0, equals), text.substr(equals + 1)};
}

void applyOverride(json& scene, const SceneOverride& change, const std::string& file) {
  const std::vector<std::string> path = splitPath(change.path);
  const std::string option = "--set " + change.path + "=" + change.value + ": ";
  json* place = &scene;
  try {
    std::vector<std::string> walked;
    for (const std::string& token : path) {
      place = &descend(*place, token, sceneSchema().placeName(walked));
      walked.push_back(token);
    }
  } catch (const std::out_of_range& error) {
    raiseInputError(file, option, error.what());
  }
  *place = parseValue(change.value, file + ": --set " + change.path);
}

}  // namespace ambient
