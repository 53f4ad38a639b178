#pragma once

#include <string>
#include <variant>
#include <vector>

namespace ambient {

/// Word or number; NaN: the run has no such number.
using TableCell = std::variant<std::string, double>;
using TableRow = std::vector<TableCell>;

struct ResultTable {
  std::vector<std::string> columns;
  std::vector<TableRow> rows;
  int missing = 0;  ///< number of cases without a result
};

/// Names of the columns of resultRows(), in order.
std::vector<std::string> resultColumns();

/// Converts the text of a summary.json to one row per body: end pose, path, fall and computational
/// work. SI units, world axes; "end_orientation" is w, x, y, z.
std::vector<TableRow> resultRows(const std::string& summary);

/// CSV text with a header; numbers have 17 significant digits.
std::string makeTableText(const ResultTable& table);

}  // namespace ambient
