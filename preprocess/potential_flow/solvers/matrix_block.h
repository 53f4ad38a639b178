#pragma once

#include <cstddef>

namespace ambient {

/// A dense block of a matrix in memory.
struct MatrixBlock {
  const float* first;
  std::ptrdiff_t rows, columns;
  std::ptrdiff_t row_stride,
      column_stride;  ///< distance in memory from one row, or column, to the next
};

/// Number of fields in a group; fields are stored side by side in whole groups.
constexpr int kFieldGroup = 8;

}  // namespace ambient
