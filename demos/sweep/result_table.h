#pragma once

#include <string>
#include <variant>
#include <vector>

namespace ambient {

/// A word or a number; a number that a run does not have is NaN.
using TableCell = std::variant<std::string, double>;
using TableRow = std::vector<TableCell>;

struct ResultTable {
  std::vector<std::string> columns;
  std::vector<TableRow> rows;
  int missing = 0;  ///< cases that are not done
};

/// What a row of resultRows() holds.
std::vector<std::string> resultColumns();

/// One row per body of the text of a summary.json: where it was at the end, its path, its fall and
/// the work for it. SI units, world axes; "end_orientation" is w, x, y, z.
std::vector<TableRow> resultRows(const std::string& summary);

/// Comma-separated, a header first; numbers have all digits.
std::string makeTableText(const ResultTable& table);

}  // namespace ambient
