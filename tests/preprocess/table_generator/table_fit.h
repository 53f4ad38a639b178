#pragma once

#include <string>
#include <vector>

#include "tests/preprocess/table_generator/table_samples.h"

namespace ambient {

/// Coefficients of a ChebyshevSeries, and the largest residual.
struct FittedSeries {
  std::string name;
  int rows = 0, columns = 0;
  std::vector<double> coefficients;  ///< row after row
  double largest_residual = 0;
};

/// All series of a table, by least squares over its samples.
/// @pre all of tableShapes() are solved
std::vector<FittedSeries> fitTable(TableShape::Kind kind, const TableSamples& samples);

/// Source text of table_data.cpp with all tables.
std::string tableSource(const TableSamples& samples);

}  // namespace ambient
