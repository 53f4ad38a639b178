#include "demos/sweep/result_table.h"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "demos/simulation/output/digits.h"

namespace ambient {
namespace {

using nlohmann::json;

/// Column, and its place in a body's entry of summary.json; is_word: text instead of a number.
struct Column {
  const char* name;
  const char* place;
  bool is_word = false;
};

constexpr Column kColumns[] = {
    {"body", "/name", true},
    {"mass", "/mass"},
    {"end_time", "/end/time"},
    {"end_position_x", "/end/position/0"},
    {"end_position_y", "/end/position/1"},
    {"end_position_z", "/end/position/2"},
    {"end_orientation_w", "/end/orientation/0"},
    {"end_orientation_x", "/end/orientation/1"},
    {"end_orientation_y", "/end/orientation/2"},
    {"end_orientation_z", "/end/orientation/3"},
    {"end_linear_velocity_x", "/end/linear_velocity/0"},
    {"end_linear_velocity_y", "/end/linear_velocity/1"},
    {"end_linear_velocity_z", "/end/linear_velocity/2"},
    {"end_angular_velocity_x", "/end/angular_velocity/0"},
    {"end_angular_velocity_y", "/end/angular_velocity/1"},
    {"end_angular_velocity_z", "/end/angular_velocity/2"},
    {"path_length", "/path/length"},
    {"largest_speed", "/path/largest_speed"},
    {"largest_height", "/path/largest_height"},
    {"landing_time", "/path/landing/time"},
    {"landing_x", "/path/landing/position/0"},
    {"landing_y", "/path/landing/position/1"},
    {"landing_z", "/path/landing/position/2"},
    {"mode", "/fall/mode", true},
    {"overturns", "/fall/overturns"},
    {"swings", "/fall/swings"},
    {"turns", "/fall/turns"},
    {"largest_swing", "/fall/largest_swing"},
    {"descent_speed", "/fall/descent_speed"},
    {"drift_speed", "/fall/drift_speed"},
    {"substeps", "/work/substeps"},
    {"load_evaluations", "/work/load_evaluations"},
    {"guarded_evaluations", "/work/guarded"},
    {"coarse_steps", "/work/coarse"},
    {"halted_steps", "/work/halted"},
    {"energy_removed", "/work/energy_removed"},
};

TableCell cellOf(const json& body, const Column& column) {
  const json::json_pointer place(column.place);
  const bool is_there = body.contains(place);
  if (column.is_word) return is_there ? body[place].get<std::string>() : std::string();
  return is_there ? body[place].get<double>() : std::numeric_limits<double>::quiet_NaN();
}

std::string cellText(const TableCell& cell) {
  if (const auto* word = std::get_if<std::string>(&cell)) {
    if (word->find_first_of(",\"\n") == std::string::npos) return *word;
    std::string quoted = "\"";
    for (const char c : *word) quoted += c == '"' ? "\"\"" : std::string(1, c);
    return quoted + "\"";
  }
  const double value = std::get<double>(cell);
  return std::isnan(value) ? "nan" : digits17(value);
}

}  // namespace

std::vector<std::string> resultColumns() {
  std::vector<std::string> names;
  for (const Column& column : kColumns) names.emplace_back(column.name);
  return names;
}

std::vector<TableRow> resultRows(const std::string& summary) {
  std::vector<TableRow> rows;
  const json parsed = json::parse(summary);
  for (const json& body : parsed.at("bodies")) {
    rows.emplace_back();
    for (const Column& column : kColumns) rows.back().push_back(cellOf(body, column));
  }
  return rows;
}

std::string makeTableText(const ResultTable& table) {
  std::string text;
  const auto append = [&text](const TableRow& row) {
    for (std::size_t i = 0; i < row.size(); ++i) text += (i > 0 ? "," : "") + cellText(row[i]);
    text += "\n";
  };
  append(TableRow(table.columns.begin(), table.columns.end()));
  for (const TableRow& row : table.rows) append(row);
  return text;
}

}  // namespace ambient
