#include "preprocess/shape/json_schema.h"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <utility>
#include <vector>

#include "preprocess/mesh/input_error.h"

namespace ambient {

namespace {

using nlohmann::json;

constexpr int kDeepestJson = 100;

// The library's message without its "[json.exception.parse_error.101] " mark, on one line.
std::string plainMessage(const json::exception& error) {
  std::string text = error.what();
  const std::size_t mark = text.find("] ");
  if (mark != std::string::npos) text.erase(0, mark + 2);
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

}  // namespace

std::string readBytes(const std::filesystem::path& file) {
  requireRegularFile(file, "regular");
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream bytes;
  bytes << stream.rdbuf();
  // Inserting nothing sets the fail bit of `bytes`: an empty file is not an error here.
  if (!stream.is_open() || stream.bad()) raiseInputError(file.string(), "cannot be read");
  return bytes.str();
}

json parseJson(const std::string& text, const std::string& source) {
  std::vector<std::set<std::string>> keys_of_open_objects;
  const auto check = [&](int depth, json::parse_event_t event, json& parsed) {
    if (depth > kDeepestJson) {
      raiseInputError(source, "is nested deeper than ", kDeepestJson, " levels");
    }
    if (event == json::parse_event_t::object_start) keys_of_open_objects.emplace_back();
    if (event == json::parse_event_t::object_end) keys_of_open_objects.pop_back();
    if (event == json::parse_event_t::key &&
        !keys_of_open_objects.back().insert(parsed.get<std::string>()).second) {
      raiseInputError(source, "key ", parsed.dump(), " is given twice in one object");
    }
    return true;
  };
  try {
    return json::parse(text, check);
  } catch (const json::exception& error) {
    raiseInputError(source, "is not valid JSON: ", plainMessage(error));
  }
}

namespace {

using Path = std::vector<std::string>;

/// A part of a schema, and the document that its "#/..." references are relative to.
struct Node {
  const json& schema;
  const json& document;
};

/// A member of a schema, null if it is not there.
const json& member(const json& schema, const char* keyword) {
  static const json none;
  const auto found = schema.find(keyword);
  return found == schema.end() ? none : *found;
}

Node resolved(const Node& node) {
  const json& reference = member(node.schema, "$ref");
  if (reference.is_null()) return node;
  const auto target = reference.get<std::string>();
  if (target.front() != '#') return {shapeSchema(), shapeSchema()};
  return {node.document.at(json::json_pointer(target.substr(1))), node.document};
}

bool hasType(const json& value, const json& type) {
  if (type.is_array()) {
    return std::any_of(type.begin(), type.end(),
                       [&](const json& choice) { return hasType(value, choice); });
  }
  return type == "integer" ? value.is_number_integer() : value.type_name() == type;
}

bool meets(const json& value, const json& condition) {
  for (const auto& [key, wanted] : condition["properties"].items())
    if (member(value, key.c_str()) != wanted["const"]) return false;
  return true;
}

std::string shortened(const std::string& text) {
  constexpr std::size_t kLongest = 60;
  return text.size() <= kLongest ? text : text.substr(0, kLongest) + "...";
}

std::string keysOf(const json& object) {
  std::string keys;
  for (const auto& entry : object.items()) keys += (keys.empty() ? "" : ", ") + entry.key();
  return keys;
}

/// Goes through a value and its schema side by side.
class Checker {
 public:
  Checker(const JsonSchema& schema, const std::string& source) : schema_(schema), source_(source) {}

  void check(const json& value, const Node& unresolved) {
    const Node node = resolved(unresolved);
    const json& type = member(node.schema, "type");
    require(type.is_null() || hasType(value, type), value, "of type " + type.dump());
    const json& words = member(node.schema, "enum");
    const bool is_word = std::find(words.begin(), words.end(), value) != words.end();
    require(words.is_null() || is_word, value, "one of " + words.dump());
    if (value.is_object()) checkObject(value, node);
    if (value.is_array()) checkArray(value, node);
    if (value.is_string())
      requireLimit("minLength", value.get<std::string>().size(), value, node.schema);
    for (const char* keyword : {"minimum", "maximum", "exclusiveMinimum"})
      if (value.is_number()) requireLimit(keyword, value, value, node.schema);
    for (const json& branch : member(node.schema, "allOf"))
      if (meets(value, branch["if"])) check(value, {branch["then"], node.document});
  }

 private:
  void require(bool holds, const json& value, const std::string& limit) const {
    if (holds) return;
    raiseInputError(source_, schema_.placeName(path_), " is ", shortened(value.dump()),
                    "; must be ", limit);
  }

  /// A number, or a count of what is in `value`, against the limit that the schema may set.
  void requireLimit(const std::string& keyword, const json& number, const json& value,
                    const json& schema) const {
    const json& limit = member(schema, keyword.c_str());
    if (limit.is_null()) return;
    if (keyword == "minimum") require(number >= limit, value, ">= " + limit.dump());
    if (keyword == "maximum") require(number <= limit, value, "<= " + limit.dump());
    if (keyword == "exclusiveMinimum") require(number > limit, value, "> " + limit.dump());
    if (keyword == "minLength")
      require(number >= limit, value, "at least " + limit.dump() + " long");
    if (keyword == "minItems")
      require(number >= limit, value, "at least " + limit.dump() + " values");
    if (keyword == "maxItems")
      require(number <= limit, value, "at most " + limit.dump() + " values");
  }

  void checkArray(const json& array, const Node& node) {
    for (const char* keyword : {"minItems", "maxItems"})
      requireLimit(keyword, array.size(), array, node.schema);
    const json& items = member(node.schema, "items");
    if (items.is_null()) return;
    for (std::size_t i = 0; i < array.size(); ++i)
      checkPart(std::to_string(i), array[i], {items, node.document});
  }

  void checkObject(const json& object, const Node& node) {
    const json& properties = member(node.schema, "properties");
    const json& others = member(node.schema, "additionalProperties");
    for (const auto& [key, value] : object.items()) {
      const json& wanted = member(properties, key.c_str());
      if (!wanted.is_null() || others.is_object()) {
        checkPart(key, value, {wanted.is_null() ? others : wanted, node.document});
      } else if (others == false) {
        raiseInputError(source_, "unknown key ", json(key).dump(), " in ", schema_.placeName(path_),
                        ", which has ", keysOf(properties));
      }
    }
    for (const json& key : member(node.schema, "required"))
      if (!object.contains(key))
        raiseInputError(source_, "key ", key.dump(), " is missing in ", schema_.placeName(path_));
  }

  void checkPart(const std::string& part, const json& value, const Node& node) {
    path_.push_back(part);
    check(value, node);
    path_.pop_back();
  }

  const JsonSchema& schema_;
  const std::string& source_;
  Path path_;
};

}  // namespace

bool isIndex(const std::string& part) {
  constexpr std::size_t kMostDigits = 9;
  return !part.empty() && part.size() <= kMostDigits &&
         std::all_of(part.begin(), part.end(), [](unsigned char c) { return std::isdigit(c); });
}

JsonSchema::JsonSchema(const json& document, std::string subject)
    : document_(document), subject_(std::move(subject)) {}

void JsonSchema::check(const json& value, const std::string& source) const {
  Checker(*this, source).check(value, {document_, document_});
}

std::string JsonSchema::placeName(const Path& path) const {
  if (path.empty()) return subject_;
  std::string name;
  for (const std::string& part : path)
    name += isIndex(part) ? "[" + part + "]" : (name.empty() ? "" : ".") + part;
  return name;
}

}  // namespace ambient
