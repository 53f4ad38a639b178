#include "preprocess/shape/json_text.h"

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
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

}  // namespace ambient
