#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace ambient {

/// Reads a file.
/// @throws std::runtime_error in one line that names the file, if it cannot be read.
std::string readBytes(const std::filesystem::path& file);

/// Parses JSON; a key given twice in one object is an error.
/// @throws std::runtime_error in one line that begins with `source`.
nlohmann::json parseJson(const std::string& text, const std::string& source);

/// Content of data/schema/shape.schema.json, compiled into the program.
const nlohmann::json& shapeSchema();

/// A schema that JSON values are checked against: the part of JSON Schema draft 7 that data/schema
/// uses; other keywords are for people. "$ref" leads into the same document or to the schema of
/// shapes. "if" compares keys with constants. "additionalProperties" is false or the schema of keys
/// that are not listed.
/// @pre the schema refers to nothing that is missing
class JsonSchema {
 public:
  /// `subject` is what messages call the value: "the scene".
  JsonSchema(const nlohmann::json& document, std::string subject);

  /// @throws std::runtime_error in one line that begins with `source` and names the place, the
  /// value and what the schema wants.
  void check(const nlohmann::json& value, const std::string& source) const;

  /// "bodies[0].mass" for {"bodies", "0", "mass"}, the subject for {}.
  std::string placeName(const std::vector<std::string>& path) const;

  const nlohmann::json& document() const { return document_; }

 private:
  const nlohmann::json& document_;
  std::string subject_;
};

/// True if a part of a path is an index into an array.
bool isIndex(const std::string& part);

}  // namespace ambient
