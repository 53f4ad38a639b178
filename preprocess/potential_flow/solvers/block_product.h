#pragma once

#include <cstddef>
#include <cstring>

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

/// y += block x for 8 or 24 fields at once; x is columns x fields, y rows x fields, both row by
/// row. The same bits on every processor.
void addBlockProduct(const MatrixBlock& block, const float* x, int fields, float* y);
void addBlockProductAvx2(const MatrixBlock& block, const float* x, int fields, float* y);

// Compiled once per instruction set: nothing here may be shared between them.
namespace {

using Floats4 = float __attribute__((vector_size(4 * sizeof(float))));
using Floats8 = float __attribute__((vector_size(8 * sizeof(float))));

/// Some rows of y += block x, kept in registers over all columns: kGroups registers per row.
template <typename Floats, int kRows, int kGroups>
void addRows(const MatrixBlock& block, const float* first, const float* x, float* y) {
  constexpr int kLanes = sizeof(Floats) / sizeof(float);
  Floats sum[kRows][kGroups];
#pragma GCC unroll 8
  for (int i = 0; i < kRows; ++i)
#pragma GCC unroll 8
    for (int k = 0; k < kGroups; ++k)
      std::memcpy(&sum[i][k], y + (i * kGroups + k) * kLanes, sizeof(Floats));
  for (std::ptrdiff_t j = 0; j < block.columns; ++j) {
    Floats source[kGroups];
#pragma GCC unroll 8
    for (int k = 0; k < kGroups; ++k)
      std::memcpy(&source[k], x + (j * kGroups + k) * kLanes, sizeof(Floats));
#pragma GCC unroll 8
    for (int i = 0; i < kRows; ++i) {
      const float entry = first[i * block.row_stride + j * block.column_stride];
#pragma GCC unroll 8
      for (int k = 0; k < kGroups; ++k) sum[i][k] += entry * source[k];
    }
  }
#pragma GCC unroll 8
  for (int i = 0; i < kRows; ++i)
#pragma GCC unroll 8
    for (int k = 0; k < kGroups; ++k)
      std::memcpy(y + (i * kGroups + k) * kLanes, &sum[i][k], sizeof(Floats));
}

template <typename Floats, int kRows, int kGroups>
void addAllRows(const MatrixBlock& block, const float* x, float* y) {
  constexpr int kFields = kGroups * static_cast<int>(sizeof(Floats) / sizeof(float));
  std::ptrdiff_t i = 0;
  for (; i + kRows <= block.rows; i += kRows)
    addRows<Floats, kRows, kGroups>(block, block.first + i * block.row_stride, x, y + i * kFields);
  for (; i < block.rows; ++i)
    addRows<Floats, 1, kGroups>(block, block.first + i * block.row_stride, x, y + i * kFields);
}

}  // namespace
}  // namespace ambient
