#pragma once

#include <cstddef>

namespace ambient {

/// A dense block of a matrix in memory.
struct MatrixBlock {
  const float* first;
  std::ptrdiff_t rows, columns;
  std::ptrdiff_t row_stride, column_stride;  ///< from one row, or column, to the next
};

/// Fields are stored side by side, in whole groups of so many.
constexpr int kFieldGroup = 8;

}  // namespace ambient
