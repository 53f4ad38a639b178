#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "bullet_ambient/spatial/vector_types.h"

namespace ambient::test {

/// Root mean square of error(i), i = 0 ... count - 1.
template <class Error>
double rootMeanSquare(int count, const Error& error) {
  double sum = 0;
  for (int i = 0; i < count; ++i) {
    const double e = error(i);
    sum += e * e;
  }
  return std::sqrt(sum / count);
}

/// Errors on a sequence of meshes, each with edges half as long as those before.
struct Convergence {
  std::vector<double> errors;

  double finest() const { return errors.back(); }
  /// Mean order between the coarsest and the finest mesh.
  double order() const {
    return std::log2(errors.front() / errors.back()) / static_cast<double>(errors.size() - 1);
  }
};

/// Returns error(level) for each level of refinement.
template <class Error>
Convergence measureConvergence(int first_level, int last_level, const Error& error) {
  Convergence convergence;
  for (int level = first_level; level <= last_level; ++level)
    convergence.errors.push_back(error(level));
  return convergence;
}

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

/// Follows an energy that must not rise, from its value at the start.
class EnergyRise {
 public:
  explicit EnergyRise(double start) : start_(start), lowest_(start) {}

  void see(double energy) {
    over_earlier_ = std::max(over_earlier_, energy - lowest_);
    over_start_ = std::max(over_start_, energy - start_);
    lowest_ = std::min(lowest_, energy);
  }
  /// Forgets what came before.
  void beginAt(double energy) { lowest_ = energy; }

  double lowest() const { return lowest_; }
  double overEarlier() const { return over_earlier_; }  ///< largest rise above an earlier value
  double overStart() const { return over_start_; }      ///< largest rise above the start

 private:
  double start_, lowest_, over_earlier_ = 0, over_start_ = 0;
};

}  // namespace ambient::test
