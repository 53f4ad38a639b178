#pragma once

#include "bullet_ambient/motion/lanes/flight_lanes.h"
#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// Symmetric 6x6 matrix in the memory of its upper triangle.
struct SymmetricMatrix : SymmetricOf<double> {
  SymmetricMatrix() = default;
  explicit SymmetricMatrix(const SymmetricOf<double>& m) : SymmetricOf<double>(m) {}
  /// Takes the upper triangle.
  explicit SymmetricMatrix(const Matrix6& m) {
    for (int row = 0; row < 6; ++row)
      for (int column = row; column < 6; ++column)
        entries[symmetricEntry(row, column)] = m(row, column);
  }

  Matrix6 full() const {
    Matrix6 m;
    for (int row = 0; row < 6; ++row)
      for (int column = row; column < 6; ++column)
        m(row, column) = m(column, row) = entries[symmetricEntry(row, column)];
    return m;
  }

  /// The part that acts on velocities of translation.
  Matrix3 bottomRight() const {
    Matrix3 m;
    for (int row = 0; row < 3; ++row)
      for (int column = row; column < 3; ++column)
        m(row, column) = m(column, row) = entries[symmetricEntry(row + 3, column + 3)];
    return m;
  }
};

}  // namespace ambient
