#include "demos/sweep/result_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>

namespace ambient {
namespace {

TEST(ResultTable, HasAPlaceForEveryColumnOfASummary) {
  const std::string summary = R"({"bodies": [{"name": "plate", "mass": 0.1,
      "end": {"time": 2, "position": [1, 2, 3], "orientation": [1, 0, 0, 0],
              "linear_velocity": [4, 5, 6], "angular_velocity": [7, 8, 9]},
      "path": {"length": 11, "landing": null}, "fall": {"mode": "flutter", "swings": 4}}]})";
  const std::vector<TableRow> rows = resultRows(summary);
  ASSERT_EQ(rows.size(), 1u);
  const std::vector<std::string> columns = resultColumns();
  ASSERT_EQ(rows[0].size(), columns.size());
  std::map<std::string, TableCell> row;
  for (std::size_t i = 0; i < columns.size(); ++i) row[columns[i]] = rows[0][i];
  EXPECT_EQ(row.size(), columns.size());  // names are unique
  EXPECT_EQ(row["body"], TableCell("plate"));
  EXPECT_EQ(row["end_position_z"], TableCell(3.0));
  EXPECT_EQ(row["end_angular_velocity_x"], TableCell(7.0));
  EXPECT_EQ(row["mode"], TableCell("flutter"));
  EXPECT_EQ(row["swings"], TableCell(4.0));
  EXPECT_TRUE(std::isnan(std::get<double>(row["landing_time"])));
}

TEST(ResultTable, KeepsAllDigitsAndQuotesCommas) {
  const ResultTable table{{"a", "b"},
                          {{0.1, std::string("plain")},
                           {std::numeric_limits<double>::quiet_NaN(), std::string("[1,\"x\"]")}}};
  EXPECT_EQ(makeTableText(table), "a,b\n0.10000000000000001,plain\nnan,\"[1,\"\"x\"\"]\"\n");
}

}  // namespace
}  // namespace ambient
