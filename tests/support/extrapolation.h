#pragma once

#include <cmath>
#include <vector>

#include "bullet_ambient/spatial/vector_types.h"

namespace ambient::test {

struct Extrapolation {
  double first;  ///< largest step; each further one is half of the last
  int columns;   ///< number of steps
  int order;     ///< first power of the step in the error; powers differ by it
};

/// Limit of value(h) for h -> 0, by Richardson's extrapolation.
template <class Value>
Vector6 limitAtZero(const Value& value, const Extrapolation& e) {
  std::vector<Vector6> table;
  for (int row = 0; row < e.columns; ++row) {
    Vector6 latest = value(std::ldexp(e.first, -row));
    for (int column = 0; column < row; ++column) {
      const Vector6 refined =
          latest + (latest - table[column]) / (std::ldexp(1.0, e.order * (column + 1)) - 1);
      table[column] = latest;
      latest = refined;
    }
    table.push_back(latest);
  }
  return table.back();
}

}  // namespace ambient::test
