#pragma once

#include "bullet_ambient/motion/lanes/flight_lanes.h"
#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// Symmetric 6x6 matrix in the memory of its upper triangle, in the order of the lanes.
class SymmetricMatrix {
 public:
  SymmetricMatrix() = default;
  /// Takes the upper triangle.
  explicit SymmetricMatrix(const Matrix6& m) {
    for (int row = 0; row < 6; ++row)
      for (int column = row; column < 6; ++column)
        entries_[symmetricEntry(row, column)] = m(row, column);
  }

  Matrix6 full() const {
    Matrix6 m;
    for (int row = 0; row < 6; ++row)
      for (int column = row; column < 6; ++column)
        m(row, column) = m(column, row) = entries_[symmetricEntry(row, column)];
    return m;
  }

  /// The part that acts on velocities of translation.
  Matrix3 bottomRight() const {
    Matrix3 m;
    for (int row = 0; row < 3; ++row)
      for (int column = row; column < 3; ++column)
        m(row, column) = m(column, row) = entries_[symmetricEntry(row + 3, column + 3)];
    return m;
  }

  /// Entries of the upper triangle, row by row.
  double& operator[](int entry) { return entries_[entry]; }
  double operator[](int entry) const { return entries_[entry]; }

 private:
  double entries_[kSymmetricEntries];
};

}  // namespace ambient
