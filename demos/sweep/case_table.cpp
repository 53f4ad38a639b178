#include "demos/sweep/case_table.h"

#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "demos/sweep/case_file.h"
#include "demos/sweep/case_runs.h"

namespace ambient {
namespace {

using Overrides = std::map<std::string, TableCell>;

/// Result of a finished case.
struct CaseResult {
  int index = 0;
  std::string key;
  Overrides overrides;  ///< values by path
  std::vector<TableRow> rows;
};

/// Converts a JSON value to a cell: number, string, or else JSON text.
TableCell toCell(const std::string& text) {
  const auto value = nlohmann::json::parse(text);
  if (value.is_number()) return value.get<double>();
  return value.is_string() ? value.get<std::string>() : text;
}

Overrides overrideCells(const Case& line) {
  Overrides cells;
  for (const SceneOverride& change : overridesOf(line)) cells[change.path] = toCell(change.value);
  return cells;
}

// Finds the result of a case; none if it is not done or cannot be read. runCases() reports errors.
std::optional<CaseResult> findResult(const Case& line, const std::filesystem::path& out) {
  try {
    const std::string key = keyOf(sceneOf(line));
    std::optional<std::vector<TableRow>> rows = resultOf(out, key);
    if (!rows) return std::nullopt;
    return CaseResult{line.index, key, overrideCells(line), *std::move(rows)};
  } catch (const std::runtime_error&) {
    return std::nullopt;
  }
}

}  // namespace

ResultTable collectCases(const std::filesystem::path& cases, const std::filesystem::path& out) {
  if (!std::filesystem::is_directory(out))
    throw std::runtime_error(out.string() + ": is not a folder, and holds no results");
  std::vector<CaseResult> results;
  ResultTable table{{"case", "key"}, {}};
  for (const Case& line : readCases(cases)) {
    if (std::optional<CaseResult> result = findResult(line, out)) {
      results.push_back(*std::move(result));
    } else {
      ++table.missing;
    }
  }
  Overrides absent;
  for (const CaseResult& result : results)
    for (const auto& entry : result.overrides)
      absent[entry.first] = std::numeric_limits<double>::quiet_NaN();
  for (const auto& entry : absent) table.columns.push_back(entry.first);
  for (const std::string& name : resultColumns()) table.columns.push_back(name);
  for (const CaseResult& result : results) {
    Overrides overrides = result.overrides;
    overrides.insert(absent.begin(), absent.end());  // empty cells for paths not overridden
    TableRow begin{static_cast<double>(result.index), result.key};
    for (const auto& entry : overrides) begin.push_back(entry.second);
    for (const TableRow& row : result.rows) {
      table.rows.push_back(begin);
      table.rows.back().insert(table.rows.back().end(), row.begin(), row.end());
    }
  }
  return table;
}

}  // namespace ambient
