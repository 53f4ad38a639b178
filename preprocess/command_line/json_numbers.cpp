#include "preprocess/command_line/json_numbers.h"

namespace ambient {
namespace {

using nlohmann::ordered_json;

std::string compact(const ordered_json& value) {
  return value.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

std::string valueText(const ordered_json& value) {
  const bool is_matrix = value.is_array() && !value.empty() && value.front().is_array();
  if (!is_matrix) return compact(value);
  std::string text = "[";
  for (std::size_t row = 0; row < value.size(); ++row) {
    text += (row > 0 ? ",\n    " : "\n    ") + compact(value[row]);
  }
  return text + "\n  ]";
}

}  // namespace

std::string jsonText(const ordered_json& object) {
  std::string text = "{";
  for (const auto& entry : object.items()) {
    text += text.size() > 1 ? ",\n  " : "\n  ";
    text += compact(entry.key()) + ": " + valueText(entry.value());
  }
  return text + "\n}\n";
}

}  // namespace ambient
