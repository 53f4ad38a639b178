#pragma once

#include <cstddef>
#include <vector>

#include "bullet_ambient/bullet/core/precision_check.h"

AMBIENT_BEGIN

// Factors a symmetric, positive definite matrix S by Cholesky's method, S = L L^T. Stores the
// entries from the first nonzero one of a row to its diagonal, and for L the inverse of the
// diagonal. Four rows stand side by side, column after column. Each sum is taken in the order of
// columns, so that its bits do not depend on how many numbers the processor takes at a time.

/// Holds a matrix of the rows of a chain of joints, and then its factor in the same place. Reuses
/// its memory.
class ChainFactor {
 public:
  /// Removes all rows.
  void clear();
  /// Appends a row; `first`: column of its first entry, at most that of its diagonal.
  void addRow(int first);
  /// Sets all entries to zero. Returns false if the factor would cost too much: chains with dozens
  /// of joints on one body.
  bool begin();
  /// Gives the entries of a row by their columns.
  class Row {
   public:
    Row(double* begin, int first) : begin_(begin), first_(first) {}
    double& operator[](int column) const { return begin_[4 * (column - first_)]; }

   private:
    double* begin_;
    int first_;
  };
  /// Returns a row up to its diagonal, to be filled between begin() and factorize().
  Row row(int i) {
    const Group& group = groups_[static_cast<std::size_t>(i / 4)];
    return {elements_.data() + group.at + i % 4, group.first};
  }
  /// Replaces the matrix by its factor. Returns false if its rows depend on each other.
  bool factorize() noexcept;
  /// Replaces x by S^-1 x. `x` has room for a multiple of four numbers, zeros beyond the rows.
  void solve(double* x) const noexcept;

  /// Four rows, or what is left of them.
  struct Group {
    int first;       ///< least column
    std::size_t at;  ///< where its elements begin
  };

 private:
  int size_ = 0;
  double work_ = 0;
  std::vector<Group> groups_;
  std::vector<double> elements_;
};

AMBIENT_END
