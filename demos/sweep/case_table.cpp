#include "demos/sweep/case_table.h"

#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "demos/sweep/case_file.h"
#include "demos/sweep/case_runs.h"
#include "preprocess/shape/json_text.h"

namespace ambient {
namespace {

using Overrides = std::map<std::string, TableCell>;

/// A case that is done.
struct CaseResult {
  int index = 0;
  std::string key;
  Overrides overrides;  ///< by their paths
};

/// A number, or a word; whatever else as JSON.
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

std::vector<CaseResult> findResults(const std::filesystem::path& cases,
                                    const std::filesystem::path& out) {
  std::vector<CaseResult> results;
  for (const Case& line : readCases(cases)) {
    try {
      const std::string key = keyOf(sceneOf(line));
      if (std::filesystem::exists(summaryFile(out, key)))
        results.push_back({line.index, key, overrideCells(line)});
    } catch (const std::runtime_error&) {
      // A case that cannot be read has failed, and runCases() says why.
    }
  }
  return results;
}

}  // namespace

ResultTable collectCases(const std::filesystem::path& cases, const std::filesystem::path& out) {
  const std::vector<CaseResult> results = findResults(cases, out);
  Overrides absent;
  for (const CaseResult& result : results)
    for (const auto& entry : result.overrides)
      absent[entry.first] = std::numeric_limits<double>::quiet_NaN();
  ResultTable table{{"case", "key"}, {}};
  for (const auto& entry : absent) table.columns.push_back(entry.first);
  for (const std::string& name : resultColumns()) table.columns.push_back(name);
  for (const CaseResult& result : results) {
    Overrides overrides = result.overrides;
    overrides.insert(absent.begin(), absent.end());  // where there is none
    TableRow begin{static_cast<double>(result.index), result.key};
    for (const auto& entry : overrides) begin.push_back(entry.second);
    for (const TableRow& row : resultRows(readBytes(summaryFile(out, result.key)))) {
      table.rows.push_back(begin);
      table.rows.back().insert(table.rows.back().end(), row.begin(), row.end());
    }
  }
  return table;
}

}  // namespace ambient
