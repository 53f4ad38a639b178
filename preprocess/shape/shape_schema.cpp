#include "preprocess/shape/shape_schema.h"

#include <memory>
#include <nlohmann/json.hpp>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validation_results.hpp>
#include <valijson/validator.hpp>
#include <vector>

#include "preprocess/mesh/input_error.h"
#include "preprocess/shape/shape_schema_text.h"

namespace ambient {
namespace {

using nlohmann::json;
using valijson::adapters::NlohmannJsonAdapter;

const valijson::Schema& compiledSchema() {
  static const std::unique_ptr<const valijson::Schema> schema = [] {
    auto compiled = std::make_unique<valijson::Schema>();
    valijson::SchemaParser().populateSchema(NlohmannJsonAdapter(shapeSchema()), *compiled);
    return compiled;
  }();
  return *schema;
}

// valijson's context {"<root>", "[semi_axes]", "[1]"} as "/semi_axes/1".
json::json_pointer placeOf(const std::vector<std::string>& context) {
  json::json_pointer place;
  for (const std::string& step : context) {
    if (step.size() > 2 && step.front() == '[') place /= step.substr(1, step.size() - 2);
  }
  return place;
}

std::string lastQuoted(const std::string& text) {
  const std::size_t last = text.rfind('\'');
  const std::size_t first = text.rfind('\'', last - 1);
  return text.substr(first + 1, last - first - 1);
}

std::string shapeName(const json& shape) {
  const bool is_named = shape.is_object() && shape.contains("type") && shape["type"].is_string();
  return is_named ? "shape \"" + shape["type"].get<std::string>() + "\"" : "the shape";
}

std::string knownKeys(const json& shape) {
  std::string keys;
  const json& definition = shapeSchema()["definitions"][shape["type"].get<std::string>()];
  for (const auto& entry : definition["properties"].items()) {
    keys += (keys.empty() ? "" : ", ") + entry.key();
  }
  return keys;
}

std::string shapeTypes() {
  std::string types;
  for (const json& type : shapeSchema()["properties"]["type"]["enum"]) {
    types += (types.empty() ? "" : ", ") + type.get<std::string>();
  }
  return types;
}

bool beginsWith(const std::string& text, const std::string& beginning) {
  return text.compare(0, beginning.size(), beginning) == 0;
}

// The error in the words of a shape; valijson knows only JSON.
std::string explain(const json& shape, const valijson::ValidationResults::Error& error) {
  const json::json_pointer place = placeOf(error.context);
  if (beginsWith(error.description, "Object contains a property")) {
    return "unknown key \"" + lastQuoted(error.description) + "\" in " + shapeName(shape) +
           ", which has " + knownKeys(shape);
  }
  if (beginsWith(error.description, "Missing required property")) {
    return "key \"" + lastQuoted(error.description) + "\" is missing in " + shapeName(shape);
  }
  if (place.empty()) return "a shape must be a JSON object, not " + shape.dump();
  const std::string value = place.to_string().substr(1) + " = " + shape[place].dump();
  if (place.back() == "type") return value + " is not a type of shape; known: " + shapeTypes();
  return value + " in " + shapeName(shape) + ": " + error.description;
}

}  // namespace

const json& shapeSchema() {
  static const json schema = json::parse(kShapeSchemaFile);
  return schema;
}

void validateShape(const json& shape, const std::string& source) {
  valijson::Validator validator(valijson::Validator::kStrongTypes);
  valijson::ValidationResults results;
  if (validator.validate(compiledSchema(), NlohmannJsonAdapter(shape), &results)) return;
  valijson::ValidationResults::Error error;
  results.popError(error);  // the first is the innermost
  raiseInputError(source, explain(shape, error));
}

}  // namespace ambient
