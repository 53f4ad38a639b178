#include "demos/scene/scene_schema.h"

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validation_results.hpp>
#include <valijson/validator.hpp>

#include "demos/scene/scene_error.h"
#include "demos/scene/schema_tree.h"
#include "preprocess/shape/shape_schema.h"

namespace ambient {
namespace {

using nlohmann::json;
using valijson::adapters::NlohmannJsonAdapter;

/// The compiled schema; building it costs milliseconds, so once per program.
const valijson::Schema& compiledSchema() {
  static const valijson::Schema* const schema = [] {
    auto* compiled = new valijson::Schema;
    valijson::SchemaParser parser;
    const auto fetch = [](const std::string& uri) -> const json* {
      return &schemaDocument(uri.substr(uri.rfind('/') + 1));
    };
    parser.populateSchema<NlohmannJsonAdapter>(
        NlohmannJsonAdapter(schemaDocument("scene.schema.json")), *compiled, fetch,
        [](const json*) {});
    return compiled;
  }();
  return *schema;
}

/// valijson's context {"<root>", "[bodies]", "[0]"} as a path {"bodies", "0"}.
std::vector<std::string> pathOf(const std::vector<std::string>& context) {
  std::vector<std::string> path;
  for (const std::string& step : context)
    if (step.size() > 2 && step.front() == '[') path.push_back(step.substr(1, step.size() - 2));
  return path;
}

const json* valueAt(const json& scene, const std::vector<std::string>& path) {
  const json* value = &scene;
  for (const std::string& token : path) {
    if (value->is_array())
      value = &value->at(std::stoul(token));
    else
      value = &value->at(token);
  }
  return value;
}

std::string quotedPart(const std::string& text) {
  const auto last = text.rfind('\'');
  const auto first = text.rfind('\'', last - 1);
  return text.substr(first + 1, last - first - 1);
}

/// What the schema says about a keyword at a place, as JSON text; empty if it says nothing.
std::string schemaWants(const std::vector<std::string>& path, const char* keyword) {
  for (const SchemaNode& at : findSchemaNodes(path))
    if (at.node->is_object() && at.node->contains(keyword)) return at.node->at(keyword).dump();
  return "";
}

std::string shortened(const std::string& text) {
  constexpr std::size_t kLongest = 60;
  return text.size() <= kLongest ? text : text.substr(0, kLongest) + "...";
}

bool startsWith(const std::string& text, const std::string& start) {
  return text.compare(0, start.size(), start) == 0;
}

/// valijson prints limits with std::to_string; drop the zeros it pads them with.
std::string withoutPadding(std::string text) {
  const auto point = text.rfind('.');
  if (point == std::string::npos || text.find_first_not_of("0", point + 1) != std::string::npos)
    return text;
  return text.substr(0, point);
}

/// One sentence for one valijson error.
std::string explain(const json& scene, const std::vector<std::string>& path,
                    const std::string& description) {
  const std::string place = path.empty() ? "the scene" : placeName(path);
  if (startsWith(description, "Object contains a property"))
    return "unknown key \"" + quotedPart(description) + "\" in " + place;
  if (startsWith(description, "Missing required property"))
    return "key \"" + quotedPart(description) + "\" is missing in " + place;
  const std::string is = place + " is " + shortened(valueAt(scene, path)->dump());
  if (startsWith(description, "Value type not permitted"))
    return is + "; must be of type " + schemaWants(path, "type");
  if (startsWith(description, "Failed to match against any enum"))
    return is + "; must be one of " + schemaWants(path, "enum");
  std::string wants = withoutPadding(description);
  wants[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(wants[0])));
  return is + "; " + wants;
}

}  // namespace

std::string placeName(const std::vector<std::string>& path) {
  std::string name;
  for (const std::string& token : path) {
    if (std::isdigit(static_cast<unsigned char>(token[0])))
      name += "[" + token + "]";
    else
      name += (name.empty() ? "" : ".") + token;
  }
  return name;
}

bool schemaKnows(const std::vector<std::string>& path) { return !findSchemaNodes(path).empty(); }

void validateAgainstSchema(const json& scene, const std::string& file) {
  valijson::Validator validator(valijson::Validator::kStrongTypes);
  valijson::ValidationResults results;
  if (validator.validate(compiledSchema(), NlohmannJsonAdapter(scene), &results)) return;
  // The first error is the innermost one: valijson reports children before their parents.
  valijson::ValidationResults::Error error;
  results.popError(error);
  const std::vector<std::string> path = pathOf(error.context);
  // The shape's own reader knows better words for what is wrong inside a shape.
  if (path.size() >= 3 && path[0] == "bodies" && path[2] == "shape") {
    const std::vector<std::string> shape(path.begin(), path.begin() + 3);
    validateShape(*valueAt(scene, shape), file + ": " + placeName(shape));
  }
  throw SceneError(file, explain(scene, path, error.description));
}

}  // namespace ambient
